#include "host/parts/transfer/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace exemplar {
namespace {

/// Appends the centers of the k * k similar triangles into which a face is divided.
void append_centers(const TriangleMesh& mesh, std::uint32_t f, std::size_t k, SurfaceSamples& samples) {
    const Face& face = mesh.faces[f];
    const Vec3d a = mesh.vertices[face[0]].cast<double>(), b = mesh.vertices[face[1]].cast<double>(),
                c = mesh.vertices[face[2]].cast<double>();
    const auto point = [&](double u, double v) { return ((1 - u - v) * a + u * b + v * c).cast<float>().eval(); };
    const auto step = 1.0 / static_cast<double>(k);
    for (std::size_t i = 0; i < k; ++i)
        for (std::size_t j = 0; i + j < k; ++j) {
            const double u = static_cast<double>(i) * step, v = static_cast<double>(j) * step;
            samples.points.push_back(point(u + step / 3, v + step / 3));
            if (i + j + 1 < k) samples.points.push_back(point(u + 2 * step / 3, v + 2 * step / 3));
        }
    samples.face.resize(samples.points.size(), f);
}

}  // namespace

SurfaceSamples sample_faces(const TriangleMesh& mesh, std::size_t count, std::size_t most) {
    const std::vector<float> areas = face_areas(mesh);
    const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
    SurfaceSamples samples;
    samples.spacing = std::sqrt(total / static_cast<double>(std::max<std::size_t>(count, 1)));
    samples.begin.reserve(mesh.face_count() + 1);
    samples.points.reserve(count + mesh.face_count());
    const double per_area = total > 0 ? static_cast<double>(count) / total : 0;
    const double largest_division = std::floor(std::sqrt(static_cast<double>(most)));
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        samples.begin.push_back(static_cast<std::uint32_t>(samples.points.size()));
        const double division = std::round(std::sqrt(double{areas[f]} * per_area));
        append_centers(mesh, f, static_cast<std::size_t>(std::clamp(division, 1.0, largest_division)), samples);
    }
    samples.begin.push_back(static_cast<std::uint32_t>(samples.points.size()));
    return samples;
}

}  // namespace exemplar
