#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/statistics.h"
#include "host/lines/extraction/lines.h"

namespace exemplar {

namespace {

struct Ball {
    Vec3d center = Vec3d::Zero();
    double radius = -1;  ///< negative: empty
    /// Has a tolerance for rounding of points on the surface.
    bool contains(const Vec3d& p) const { return (p - center).norm() <= radius * (1 + 1e-9); }
};

/// Returns the smallest ball with these points, at most four, on its surface.
Ball ball_through(const std::vector<Vec3d>& points) {
    if (points.size() == 1) return {points[0], 0};
    // Its center is points[0] + sum of x_i (points[i] - points[0]), at the same distance from all.
    const auto count = static_cast<Eigen::Index>(points.size()) - 1;
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> to(3, count);
    for (Eigen::Index i = 0; i < count; ++i) to.col(i) = points[static_cast<std::size_t>(i) + 1] - points[0];
    const Eigen::MatrixXd gram = to.transpose() * to;
    const Eigen::VectorXd x = gram.fullPivLu().solve(0.5 * gram.diagonal());
    const Vec3d offset = to * x;
    return {points[0] + offset, offset.norm()};
}

/// Returns the smallest ball around `support` (at most four points) and `last`, with `last` on its surface.
/// `support` becomes the points on its surface.
Ball ball_around(std::vector<Vec3d>& support, const Vec3d& last) {
    Ball best;
    std::vector<Vec3d> best_support;
    for (unsigned subset = 0; subset < (1u << support.size()); ++subset) {
        std::vector<Vec3d> chosen = {last};
        for (std::size_t i = 0; i < support.size(); ++i)
            if (subset >> i & 1u) chosen.push_back(support[i]);
        if (chosen.size() > 4) continue;
        const Ball ball = ball_through(chosen);
        const bool around_all =
            std::all_of(support.begin(), support.end(), [&](const Vec3d& p) { return ball.contains(p); });
        if (!around_all || (best.radius >= 0 && ball.radius >= best.radius)) continue;
        best = ball;
        best_support = std::move(chosen);
    }
    support = std::move(best_support);
    return best;
}

/// Returns the radius of the smallest sphere around all points. The farthest point is added to the supporting points
/// until none is outside; each addition increases the radius, so this terminates.
double bounding_radius(std::span<const Vec3> points) {
    constexpr int k_max_steps = 1000;  // a few are needed
    if (points.empty()) return 0;
    std::vector<Vec3d> support = {points[0].cast<double>()};
    Ball ball{support[0], 0};
    for (int step = 0; step < k_max_steps; ++step) {
        double farthest = 0;
        Vec3d outside = ball.center;
        for (const Vec3& p : points) {
            const double squared = (p.cast<double>() - ball.center).squaredNorm();
            if (!(squared > farthest)) continue;
            farthest = squared;
            outside = p.cast<double>();
        }
        if (ball.contains(outside)) break;
        const Ball larger = ball_around(support, outside);
        if (!(larger.radius > ball.radius)) break;
        ball = larger;
    }
    return ball.radius;
}

}  // namespace

float feature_size(std::span<const Vec3> vertices, const VertexCurvature& curvature) {
    if (curvature.k1.size() != vertices.size() || curvature.k2.size() != vertices.size())
        throw UsageError(fmt::format("{} curvatures for {} vertices: estimate them for the same mesh",
                                     curvature.k1.size(), vertices.size()));
    if (vertices.empty()) return 0;
    std::vector<float> magnitudes;
    magnitudes.reserve(2 * vertices.size());
    for (const float k : curvature.k1) magnitudes.push_back(std::abs(k));
    for (const float k : curvature.k2) magnitudes.push_back(std::abs(k));
    const float tenth = order_statistic(std::span<float>(magnitudes), magnitudes.size() / 10);
    const double by_extent = 0.05 * bounding_radius(vertices);
    return static_cast<float>(tenth > 0 ? std::min(0.01 / static_cast<double>(tenth), by_extent) : by_extent);
}

}  // namespace exemplar
