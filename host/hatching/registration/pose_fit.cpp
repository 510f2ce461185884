#include "host/hatching/registration/pose_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace exemplar {
namespace {

constexpr double k_usual_distance = 4;      ///< radii
constexpr double k_distance_weight = 2e-6;  ///< of the prior, per match, for gaps in radii
constexpr double k_fit_damping = 1e-6;
constexpr double k_max_step = 0.3;  ///< radians, logarithms, radii

using Normal = Eigen::Matrix<double, 7, 7>;

/// Returns how a point moves in the picture with each parameter of the pose, in radii of the object.
Eigen::Matrix<double, 2, 7> movement(const ViewPose& pose, const PoseFrame& frame, const Vec3d& point) {
    constexpr double k_step = 1e-5;
    Eigen::Matrix<double, 2, 7> moves;
    for (int i = 0; i < 7; ++i) {
        const PoseChange step = PoseChange::Unit(i) * k_step;
        moves.col(i) = (projected(changed(pose, frame, step), frame, point) -
                        projected(changed(pose, frame, -step), frame, point)) /
                       (2 * k_step * pose.scale * frame.radius);
    }
    return moves;
}

}  // namespace

PoseChange fitting_change(const ViewPose& pose, const PoseFrame& frame, const std::vector<LineMatch>& matches,
                          double scale) {
    const double pixels = pose.scale * frame.radius;
    Normal normal = Normal::Zero();
    PoseChange right = PoseChange::Zero();
    double total = 0;
    for (const LineMatch& match : matches) {
        const PoseChange row = movement(pose, frame, match.point).transpose() * match.normal;
        const double weight = 1 / (1 + match.gap * match.gap / (scale * scale));
        normal += weight * row * row.transpose();
        right += weight * match.gap / pixels * row;
        total += weight;
    }
    normal(3, 3) += k_distance_weight * total;
    right[3] += k_distance_weight * total * std::log(k_usual_distance * frame.radius / pose.distance);
    normal.diagonal().array() += k_fit_damping * (total + 1e-9);
    PoseChange change = normal.ldlt().solve(right);
    const double largest = change.cwiseAbs().maxCoeff();
    if (!std::isfinite(largest)) return PoseChange::Zero();
    if (largest > k_max_step) change *= k_max_step / largest;
    // The eye stays outside of the object.
    const double nearest = std::log(1.1 * frame.radius / pose.distance),
                 farthest = std::log(60 * frame.radius / pose.distance);
    change[3] = std::clamp(change[3], std::min(nearest, 0.0), std::max(farthest, 0.0));
    return change;
}

}  // namespace exemplar
