#include "host/mesh/curvature/face_fit.h"

#include <algorithm>
#include <cmath>

namespace exemplar {

namespace {

/// Returns the area of the part of a triangle nearest to each corner (Meyer et al. 2003), from its squared edge
/// lengths. At an obtuse angle the Voronoi cells are cut off at the opposite edge.
std::array<float, 3> voronoi_areas(const std::array<double, 3>& squared_length, double area) {
    const auto& l = squared_length;
    std::array<double, 3> result;
    const double sum = l[0] + l[1] + l[2];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        if (2 * l[i] >= sum) {
            // If the angle at corner i is obtuse, each other corner gets a right triangle over half its edge to i:
            // an eighth of that edge's squared length times the tangent of its own angle.
            result[j] = l[k] * area / (2 * (sum - 2 * l[j]));
            result[k] = l[j] * area / (2 * (sum - 2 * l[k]));
            result[i] = area - result[j] - result[k];
            return rounded(result);
        }
    }
    const double scale = 1 / (32 * area);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        result[i] = (l[j] * (sum - 2 * l[j]) + l[k] * (sum - 2 * l[k])) * scale;
    }
    return rounded(result);
}

}  // namespace

void measure_face(const std::array<Vec3, 3>& corners, FaceFit& fit) {
    // In double, the products of float coordinates neither cancel nor underflow.
    const Vec3d p0 = corners[0].cast<double>(), p1 = corners[1].cast<double>(), p2 = corners[2].cast<double>();
    const Vec3d e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0;
    const Vec3d n = e0.cross(e1);
    const std::array<double, 3> squared = {e0.squaredNorm(), e1.squaredNorm(), e2.squaredNorm()};
    const double longest = std::max({squared[0], squared[1], squared[2]});
    const double twice_area = n.norm();
    fit.normal = Vec3d::Zero();
    fit.normal_weight = fit.corner_area = {};
    // The weight of Max 1999 is sine over the two edge lengths, or |n| over their squares. Here n is divided by all
    // three squares, and the opposite edge's square becomes the corner's weight, in units of the longest. The test
    // for zero edges is needed because fused products can leave n slightly above zero there.
    if (squared[0] > 0 && squared[1] > 0 && squared[2] > 0) {
        fit.normal = n / ((squared[0] / longest) * squared[1] * squared[2]);
        for (std::size_t i = 0; i < 3; ++i) fit.normal_weight[i] = static_cast<float>(squared[i] / longest);
    }
    // Thinner slivers are rounding noise, and the differences of squares in voronoi_areas would vanish.
    fit.valid = twice_area > 1e-7 * longest;
    if (!fit.valid) return;

    fit.corner_area = voronoi_areas(squared, 0.5 * twice_area);
    const double length = std::sqrt(squared[0]), inverse = 1 / length;
    const double along = e0.dot(e1) * inverse, height = twice_area * inverse;
    fit.edge[0] = Vec2(static_cast<float>(length), 0.0f);
    fit.edge[1] = Vec2(static_cast<float>(along), static_cast<float>(height));
    fit.edge[2] = Vec2(static_cast<float>(-length - along), static_cast<float>(-height));
    fit.frame.tangent = (e0 * inverse).cast<float>();
    fit.frame.normal = (n / twice_area).cast<float>();
    fit.frame.bitangent = fit.frame.normal.cross(fit.frame.tangent);
}

}  // namespace exemplar
