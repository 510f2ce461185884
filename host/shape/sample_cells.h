#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "host/shape/prepared_mesh.h"

namespace exemplar {

/// Total weight, first and second moments of points.
struct SurfaceMoments {
    std::array<double, 10> sums{};  ///< w, wx, wy, wz, wxx, wxy, wxz, wyy, wyz, wzz
    void add(const Vec3d& p, double w) {
        const double x = w * p.x(), y = w * p.y(), z = w * p.z();
        const std::array<double, 10> terms{w,         x,         y,         z,         x * p.x(),
                                           x * p.y(), x * p.z(), y * p.y(), y * p.z(), z * p.z()};
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += terms[k];
    }
    /// Adds all points of `other`, their weights times `share`.
    void add(const SurfaceMoments& other, double share) {
        for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += share * other.sums[k];
    }
    /// Returns the covariance; zero if there is no weight.
    Eigen::Matrix3d covariance() const;
};

/// The part of the surface nearest to a sample.
struct SampleCell {
    SurfaceMoments moments;  ///< of the face centers, weighted by area share
    float radius = 0.0F;     ///< of a disk of the same area; 0 if every face is a sample
    /// Returns the share of the cell within `limit` of a face that is `distance` away from its sample: linear where
    /// the limit crosses the cell, otherwise 0 or 1, so that sums over cells change smoothly. Infinite distances
    /// give 0.
    float share_within(float distance, float limit) const {
        if (!(distance < limit + radius)) return distance <= limit ? 1.0F : 0.0F;
        return radius > 0.0F ? std::clamp(0.5F + (limit - distance) / (2.0F * radius), 0.0F, 1.0F) : 1.0F;
    }
};
/// Computes the cells of all samples; every face belongs to its nearest sample.
std::vector<SampleCell> sample_cells(const PreparedMesh& prepared);
/// Computes only their radii.
std::vector<float> sample_cell_radii(const PreparedMesh& prepared);

}  // namespace exemplar
