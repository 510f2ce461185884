#include "host/labeling/features/context.h"

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/parallel.h"

namespace exemplar {
namespace {

// Geodesic ranges are sample-major: neighboring faces share cache lines.
constexpr std::size_t k_reference_face_block = 16;

// The mass that each sample adds for each class: a_j P(l | j), samples x classes.
std::vector<double> reference_masses(const ContextGeometry& geometry, std::span<const float> probabilities,
                                     std::size_t classes) {
    std::vector<double> masses;
    masses.reserve(geometry.sample_face.size() * classes);
    for (std::size_t j = 0; j < geometry.sample_face.size(); ++j)
        for (std::size_t l = 0; l < classes; ++l)
            masses.push_back(static_cast<double>(geometry.sample_area[j]) *
                             static_cast<double>(probabilities[geometry.sample_face[j] * classes + l]));
    return masses;
}

// The range of a face's distance to a sample, or k_no_bin where there is no path.
std::size_t bin_of(const ContextGeometry& geometry, std::size_t measure, std::size_t face, std::size_t sample) {
    if (measure == 0) return geometry.geodesic_bin[sample * geometry.faces + face];
    const float* positions = geometry.axis_position.data() + (measure - 1) * geometry.faces;
    const float distance = std::abs(positions[face] - positions[geometry.sample_face[sample]]);
    return static_cast<std::size_t>(
        std::ranges::count_if(geometry.axis_edges[measure - 1], [&](float edge) { return edge <= distance; }));
}

// One face's histograms of all measures: measures x bins x classes.
void add_sample_masses(const ContextGeometry& geometry, std::span<const double> masses, std::size_t classes,
                       std::size_t face, std::span<double> histograms) {
    for (std::size_t j = 0; j < geometry.sample_face.size(); ++j) {
        const double* mass = masses.data() + j * classes;
        for (std::size_t measure = 0; measure < k_context_measures; ++measure) {
            const std::size_t bin = bin_of(geometry, measure, face, j);
            if (bin >= k_context_bins) continue;
            double* sum = histograms.data() + (measure * k_context_bins + bin) * classes;
            for (std::size_t l = 0; l < classes; ++l) sum[l] += mass[l];
        }
    }
}

void accumulate_reference(const ContextMesh& mesh, std::size_t classes) {
    const ContextGeometry& geometry = *mesh.geometry;
    const std::vector<double> masses = reference_masses(geometry, mesh.probabilities, classes);
    const std::size_t columns = k_context_measures * k_context_bins * classes;
    parallel_ranges(geometry.faces, k_reference_face_block, [&](std::size_t begin, std::size_t end) {
        std::vector<double> histograms(columns);
        for (std::size_t face = begin; face < end; ++face) {
            std::ranges::fill(histograms, 0.0);
            add_sample_masses(geometry, masses, classes, face, histograms);
            for (std::size_t column = 0; column < columns; ++column)
                mesh.out[column * geometry.faces + face] = static_cast<float>(histograms[column]);
        }
    });
}

}  // namespace

void check_geometry(const ContextGeometry& geometry) {
    const std::size_t samples = geometry.sample_face.size();
    const bool consistent =
        geometry.sample_area.size() == samples && geometry.geodesic_bin.size() == samples * geometry.faces &&
        geometry.axis_position.size() == k_context_axes * geometry.faces &&
        std::ranges::all_of(geometry.sample_face, [&](std::uint32_t face) { return face < geometry.faces; });
    if (!consistent) throw UsageError("the sizes of a ContextGeometry contradict each other; compute it again");
}

void check_context(const ContextMesh& mesh, std::size_t classes) {
    check_geometry(*mesh.geometry);
    const std::size_t faces = mesh.geometry->faces;
    if (classes == 0 || mesh.probabilities.size() != faces * classes)
        throw UsageError("contextual histograms need probabilities of faces x classes, with at least one class");
    if (mesh.out.size() != k_context_measures * k_context_bins * classes * faces)
        throw UsageError("contextual histograms need an output of measures x bins x classes x faces");
}

void CpuContextHistograms::accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) {
    for (const ContextMesh& mesh : meshes) check_context(mesh, classes);
    for (const ContextMesh& mesh : meshes) accumulate_reference(mesh, classes);
}

}  // namespace exemplar
