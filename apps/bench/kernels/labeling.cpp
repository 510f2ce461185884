// Contextual label histograms of random geometry: 1000 samples, 8 classes.

#include <cmath>
#include <cstdint>

#include "apps/bench/kernels/operation.h"
#include "embedded/labeling_context_axes_comp.h"
#include "embedded/labeling_context_geodesic_comp.h"
#include "gpu/labeling/context_histograms.h"
#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::size_t k_label_classes = 8, k_samples = 1000;
constexpr std::size_t k_context_columns = k_context_measures * k_context_bins * k_label_classes;

ContextGeometry random_geometry(std::size_t faces, Random& random) {
    ContextGeometry geometry;
    geometry.faces = faces;
    for (std::size_t j = 0; j < k_samples; ++j)
        geometry.sample_face.push_back(static_cast<std::uint32_t>(random.index(faces)));
    geometry.sample_area.assign(k_samples, 1.0f / k_samples);
    geometry.geodesic_bin.resize(k_samples * faces);
    for (std::uint8_t& bin : geometry.geodesic_bin) bin = static_cast<std::uint8_t>(random.next() % k_context_bins);
    geometry.axis_position.resize(k_context_axes * faces);
    for (float& position : geometry.axis_position) position = static_cast<float>(random.uniform(0.0, 2.0));
    for (auto& edges : geometry.axis_edges) edges = {0.2f, 0.5f, 0.95f, 1.5f};
    return geometry;
}

struct Histograms {
    Histograms(Device& device, Profiler& profiler, std::size_t faces)
        : geometry(random_geometry(faces, random)),
          probabilities(faces * k_label_classes, 1.0f / k_label_classes),
          actual(k_context_columns * faces),
          histograms(device, &profiler) {}
    void run() { histograms.accumulate(geometry, probabilities, k_label_classes, actual); }
    std::vector<Difference> differences() const {
        std::vector<float> expected(actual.size());
        CpuContextHistograms().accumulate(geometry, probabilities, k_label_classes, expected);
        return {{"histograms", largest_difference(actual, expected), 1e-5}};
    }
    // Geodesic ranges: a byte and a sum per sample and class. Axes: two binary searches per inner edge, three sums per
    // bin and class.
    std::map<std::string, Work> work() const {
        const auto faces = static_cast<double>(geometry.faces);
        const double searches = k_context_axes * 2 * (k_context_bins - 1) * std::log2(k_samples);
        const double of_axes = k_context_axes * k_context_bins * k_label_classes;
        return {
            {"labeling/context_geodesic.comp",
             {.bytes = faces * (k_samples + 4 * k_context_bins * k_label_classes),
              .operations = faces * k_samples * k_label_classes}},
            {"labeling/context_axes.comp",
             {.bytes = faces * 4 * (k_context_axes + of_axes), .operations = faces * (2 * searches + 3 * of_axes)}}};
    }
    Random random{2};
    ContextGeometry geometry;
    std::vector<float> probabilities, actual;
    GpuContextHistograms histograms;
};

}  // namespace

std::vector<OperationKind> labeling_operations() {
    return {{"contextual histograms",
             "faces",
             {5'000, 20'000, 100'000},
             {&shaders::labeling_context_geodesic_comp, &shaders::labeling_context_axes_comp},
             {k_context_faces},
             prepare_as<Histograms>}};
}

}  // namespace exemplar
