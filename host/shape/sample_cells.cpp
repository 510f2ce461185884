#include "host/shape/sample_cells.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace exemplar {

Eigen::Matrix3d SurfaceMoments::covariance() const {
    if (!(sums[0] > 0.0)) return Eigen::Matrix3d::Zero();
    const Vec3d mean = Vec3d(sums[1], sums[2], sums[3]) / sums[0];
    Eigen::Matrix3d second;
    second << sums[4], sums[5], sums[6], sums[5], sums[7], sums[8], sums[6], sums[8], sums[9];
    return second / sums[0] - mean * mean.transpose();
}

std::vector<float> sample_cell_radii(const PreparedMesh& prepared) {
    std::vector<float> radii(prepared.sample_count(), 0.0F);
    if (prepared.samples_are_all_faces()) return radii;
    for (std::size_t s = 0; s < radii.size(); ++s) {
        radii[s] = std::sqrt(prepared.samples.area_share[s] * prepared.total_area / std::numbers::pi_v<float>);
    }
    return radii;
}

std::vector<SampleCell> sample_cells(const PreparedMesh& prepared) {
    const std::size_t faces = prepared.face_count(), samples = prepared.sample_count();
    std::vector<std::uint32_t> nearest(faces, 0);
    std::vector<float> least(faces, std::numeric_limits<float>::infinity());
    for (std::size_t s = 0; s < samples; ++s) {
        const float* row = prepared.distance.data() + s * faces;
        for (std::size_t f = 0; f < faces; ++f) {
            if (row[f] < least[f]) {
                least[f] = row[f];
                nearest[f] = static_cast<std::uint32_t>(s);
            }
        }
    }
    std::vector<SampleCell> cells(samples);
    for (std::size_t f = 0; f < faces; ++f) {
        if (std::isinf(least[f])) continue;  // with more components than samples the smallest have none
        cells[nearest[f]].moments.add(prepared.center[f].cast<double>(), static_cast<double>(prepared.area_share[f]));
    }
    const std::vector<float> radii = sample_cell_radii(prepared);
    for (std::size_t s = 0; s < samples; ++s) cells[s].radius = radii[s];
    return cells;
}

}  // namespace exemplar
