#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/shape/sample_cells.h"
#include "host/shape/shape_families.h"

namespace exemplar {

std::string at_radius(const std::string& name, double share) {
    return fmt::format("{}@{}", name, share);
}

namespace {

/// The three singular values and the twelve ratios of the text.
constexpr std::array<const char*, 15> k_columns{"s1",     "s2",          "s3",          "s1/sum",      "s2/sum",
                                                "s3/sum", "(s1+s2)/sum", "(s1+s3)/sum", "(s2+s3)/sum", "s1/s2",
                                                "s1/s3",  "s2/s3",       "s1/s2+s1/s3", "s1/s2+s2/s3", "s1/s3+s2/s3"};

std::array<float, k_columns.size()> pca_values(const Eigen::Matrix3d& covariance, float radius) {
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(covariance, Eigen::EigenvaluesOnly);
    const auto deviation = [&](Eigen::Index k) {
        return static_cast<float>(std::sqrt(std::max(solver.eigenvalues()[k], 0.0))) / radius;
    };
    const float s1 = std::max(deviation(2), 1e-6F);  // a single point has no extent; its ratios are 1
    const float least = s1 > 1e-6F ? 0.01F * s1 : s1;
    const float s2 = std::max(deviation(1), least), s3 = std::max(deviation(0), least), sum = s1 + s2 + s3;
    return {s1,
            s2,
            s3,
            s1 / sum,
            s2 / sum,
            s3 / sum,
            (s1 + s2) / sum,
            (s1 + s3) / sum,
            (s2 + s3) / sum,
            s1 / s2,
            s1 / s3,
            s2 / s3,
            s1 / s2 + s1 / s3,
            s1 / s2 + s2 / s3,
            s1 / s3 + s2 / s3};
}

/// Returns how many of the radii are measured from all faces: those whose region has too few samples to represent
/// it.
std::size_t count_exact_radii(const PreparedMesh& prepared, std::size_t radii) {
    constexpr double k_enough_samples = 100.0;
    if (prepared.samples_are_all_faces() || !(prepared.total_area > 0.0F)) return radii;
    std::size_t count = 0;
    for (std::size_t scale = 0; scale < radii; ++scale) {
        const double radius = PcaFamily::k_radii[scale] * static_cast<double>(prepared.median_distance);
        const double area_share = std::numbers::pi * radius * radius / static_cast<double>(prepared.total_area);
        if (area_share * static_cast<double>(prepared.sample_count()) < k_enough_samples) ++count;
    }
    return count;
}

}  // namespace

PcaFamily::PcaFamily(const PreparedMesh& prepared, std::size_t radii)
    : prepared_(&prepared),
      radii_(radii),
      exact_radii_(count_exact_radii(prepared, radii)),
      cut_short_(prepared.face_count(), {exact_radii_, 0.0}) {
    unary_.rows = prepared.face_count();
    for (std::size_t scale = 0; scale < radii_; ++scale) {
        for (const char* column : k_columns) unary_.add(at_radius(std::string("pca.") + column, k_radii[scale]));
    }
}

float PcaFamily::radius() const {
    return exact_radii_ == 0 ? 0.0F : static_cast<float>(k_radii[exact_radii_ - 1]) * prepared_->median_distance;
}

void PcaFamily::keep(std::size_t scale, std::size_t face, const SurfaceMoments& moments) {
    const Eigen::Matrix3d covariance = moments.covariance();
    const auto values = pca_values(covariance, static_cast<float>(k_radii[scale]) * prepared_->median_distance);
    for (std::size_t k = 0; k < values.size(); ++k) unary_.column(scale * values.size() + k)[face] = values[k];
    if (covariances_.empty()) return;
    const Eigen::Matrix3f c = covariance.cast<float>();
    covariances_[scale][face] = {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)};
}

void PcaFamily::measure(std::uint32_t face, Neighborhood neighborhood) {
    SurfaceMoments moments;
    std::size_t added = 0;
    for (std::size_t scale = 0; scale < exact_radii_; ++scale) {
        const float radius = static_cast<float>(k_radii[scale]) * prepared_->median_distance;
        const bool complete = radius < neighborhood.complete_distance;
        const std::size_t end =
            complete ? count_within(neighborhood, radius, k_min_region_faces) : neighborhood.faces.size();
        for (; added < end; ++added) {
            const std::uint32_t near = neighborhood.faces[added].face;
            const Vec3 offset = prepared_->center[near] - prepared_->center[face];
            moments.add(offset.cast<double>(), static_cast<double>(prepared_->area_share[near]));
        }
        keep(scale, face, moments);
        if (!complete) cut_short_[face].first_scale = std::min(cut_short_[face].first_scale, scale);
    }
    cut_short_[face].area_share = moments.sums[0];
}

/// Sums the samples' cells. Where they hold less than the nearest faces of a region that was cut short, because there
/// are few samples, those faces represent it better.
void PcaFamily::measure_large_radii() {
    const auto none = [&](const CutShort& cut) { return cut.first_scale == radii_; };
    if (std::ranges::all_of(cut_short_, none)) return;
    const std::vector<SampleCell> cells = sample_cells(*prepared_);
    const std::size_t samples = cells.size();
    parallel_ranges(unary_.rows, 64, [&](std::size_t begin, std::size_t end) {
        std::vector<float> distance;
        gather_distances(*prepared_, begin, end, distance);
        for (std::size_t f = begin; f < end; ++f) {
            for (std::size_t scale = cut_short_[f].first_scale; scale < radii_; ++scale) {
                const float radius = static_cast<float>(k_radii[scale]) * prepared_->median_distance;
                SurfaceMoments moments;
                for (std::size_t s = 0; s < samples; ++s) {
                    const float share = cells[s].share_within(distance[(f - begin) * samples + s], radius);
                    if (share > 0.0F) moments.add(cells[s].moments, static_cast<double>(share));
                }
                if (scale >= exact_radii_ || moments.sums[0] > cut_short_[f].area_share) keep(scale, f, moments);
            }
        }
    });
}

}  // namespace exemplar
