#include "host/parts/splitting/loop_triangulation.h"

#include <Eigen/Geometry>
#include <limits>

#include "host/core/interrupt.h"

namespace exemplar {
namespace {

using MayJoin = std::function<bool(std::uint32_t, std::uint32_t)>;

constexpr std::size_t k_longest_whole_loop = 256, k_pieces_of_loop = 128;

/// The cost of a triangle. In a planar polygon all triangulations without folds have the same area; the lengths of the
/// edges then prefer compact triangles.
double triangle_cost(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    constexpr double k_length_weight = 0.02;
    return (b - a).cross(c - a).norm() / 2 +
           k_length_weight * ((b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm());
}

/// The dynamic programme over sub-polygons i, i + 1, ..., j of the polygon that `corners` select.
class LoopProgramme {
  public:
    LoopProgramme(std::span<const Vec3> points, std::span<const Vec3> inward, std::vector<std::uint32_t> corners)
        : inward_(inward),
          corners_(std::move(corners)),
          count_(corners_.size()),
          cost_(count_ * count_, 0),
          middle_(count_ * count_, 0) {
        points_.reserve(count_);
        for (const std::uint32_t corner : corners_) points_.push_back(points[corner].cast<double>());
    }

    /// Appends the best triangulation; returns false if there is none.
    bool append_to(std::vector<Face>& faces, const MayJoin& may_join) {
        for (std::size_t span = 2; span < count_; ++span) {
            check_interrupt();
            for (std::size_t i = 0; i + span < count_; ++i) solve(i, i + span, may_join);
        }
        if (!(cost_[count_ - 1] < std::numeric_limits<double>::infinity())) return false;
        collect(faces);
        return true;
    }

  private:
    void solve(std::size_t i, std::size_t j, const MayJoin& may_join) {
        double& best = cost_[i * count_ + j];
        best = std::numeric_limits<double>::infinity();
        const bool is_side = i == 0 && j == count_ - 1;
        if (!is_side && !may_join(corners_[i], corners_[j])) return;
        for (std::size_t k = i + 1; k < j; ++k) {
            const double inner = cost_[i * count_ + k] + cost_[k * count_ + j];
            if (inner >= best) continue;
            const double cost = inner + triangle_cost(points_[i], points_[k], points_[j]) + fold_cost(i, k, j);
            if (cost < best) best = cost, middle_[i * count_ + j] = static_cast<std::uint32_t>(k);
        }
    }
    /// The cost of the triangle's directions at the sides of the loop on which it lies.
    double fold_cost(std::size_t i, std::size_t k, std::size_t j) const {
        if (inward_.empty()) return 0;
        double cost = 0;
        if (k == i + 1) cost += fold_at_side(i, k, j);
        if (j == k + 1) cost += fold_at_side(k, j, i);
        if (i == 0 && j == count_ - 1) cost += fold_at_side(j, i, k);
        return cost;
    }
    /// A triangle on the side a b with the third corner c: its direction from the side should lead into the solid.
    double fold_at_side(std::size_t a, std::size_t b, std::size_t c) const {
        constexpr double k_fold_weight = 0.5;
        if ((corners_[a] + 1) % inward_.size() != corners_[b]) return 0;  // an inner edge of a divided loop
        const Vec3d side = points_[b] - points_[a], to_corner = points_[c] - points_[a];
        const double length = side.squaredNorm();
        if (!(length > 0)) return 0;
        const Vec3d across = to_corner - side * (side.dot(to_corner) / length);
        const double norm = across.norm();
        const double along = norm > 0 ? across.dot(inward_[corners_[a]].cast<double>()) / norm : 0;
        return k_fold_weight * length * (1 - along) * (1 - along);
    }
    void collect(std::vector<Face>& faces) const {
        std::vector<std::array<std::size_t, 2>> open{{0, count_ - 1}};
        while (!open.empty()) {
            const auto [i, j] = open.back();
            open.pop_back();
            if (j - i < 2) continue;
            const std::size_t k = middle_[i * count_ + j];
            faces.push_back({corners_[i], corners_[k], corners_[j]});
            open.push_back({i, k});
            open.push_back({k, j});
        }
    }

    std::span<const Vec3> inward_;  ///< per side of the whole loop; empty for none
    std::vector<std::uint32_t> corners_;
    std::size_t count_;
    std::vector<Vec3d> points_;
    std::vector<double> cost_;           ///< per sub-polygon i, j
    std::vector<std::uint32_t> middle_;  ///< third corner of the triangle on the side i, j
};

std::vector<std::uint32_t> consecutive_corners(std::size_t begin, std::size_t end, std::size_t count) {
    std::vector<std::uint32_t> corners;
    corners.reserve(end - begin + 1);
    for (std::size_t i = begin; i <= end; ++i) corners.push_back(static_cast<std::uint32_t>(i % count));
    return corners;
}

}  // namespace

std::optional<std::vector<Face>> triangulate_loop(std::span<const Vec3> points, std::span<const Vec3> inward,
                                                  const MayJoin& may_join) {
    const std::size_t count = points.size();
    std::vector<Face> faces;
    if (count < 3) return {};
    faces.reserve(count - 2);
    if (count <= k_longest_whole_loop) {
        if (!LoopProgramme(points, inward, consecutive_corners(0, count - 1, count)).append_to(faces, may_join))
            return {};
        return faces;
    }
    std::vector<std::uint32_t> coarse;
    coarse.reserve(k_pieces_of_loop);
    for (std::size_t piece = 0; piece < k_pieces_of_loop; ++piece) {
        const std::size_t begin = piece * count / k_pieces_of_loop, end = (piece + 1) * count / k_pieces_of_loop;
        coarse.push_back(static_cast<std::uint32_t>(begin));
        if (end - begin < 2) continue;
        const std::vector<std::uint32_t> corners = consecutive_corners(begin, end, count);
        if (!may_join(corners.front(), corners.back())) return {};
        if (corners.size() > k_longest_whole_loop) return {};
        if (!LoopProgramme(points, inward, corners).append_to(faces, may_join)) return {};
    }
    if (!LoopProgramme(points, inward, coarse).append_to(faces, may_join)) return {};
    return faces;
}

}  // namespace exemplar
