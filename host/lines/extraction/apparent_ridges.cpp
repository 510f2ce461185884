#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/lines/extraction/line_fields.h"
#include "host/lines/extraction/view_curvature.h"

namespace exemplar {

namespace {

constexpr std::size_t k_ridge_grain = 4096;  // vertices that one thread takes at a time

/// Sum and number of the difference quotients of q along the direction of a vertex.
struct Slope {
    float sum = 0;
    int count = 0;
};

float cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Adds the quotient in one face at a vertex if the direction of the vertex, forward or backward, leads into the
/// face. to_a, to_b: edges from the vertex to the other corners, in (e1, e2).
void add_slope(const ViewCurvature& here, const Vec2& to_a, const Vec2& to_b, float q_a, float q_b, Slope& slope) {
    const float length = here.direction.norm();
    for (const float sign : {1.0f, -1.0f}) {
        const Vec2 direction = sign * here.direction;
        const float beside_a = cross(to_a, direction), beside_b = cross(direction, to_b);
        if (!(beside_a >= 0 && beside_b > 0)) continue;
        const float t = beside_a / (beside_a + beside_b);
        const Vec2 across = to_a + t * (to_b - to_a);
        const float on_screen = across.dot(direction) / (length * length);
        if (!(on_screen > 0)) continue;
        slope.sum += sign * (q_a + t * (q_b - q_a) - here.q) / on_screen;
        ++slope.count;
    }
}

}  // namespace

std::vector<LineField> apparent_ridge_field(const LineSurface& surface, const LineOptions& options) {
    const VertexCurvature& c = surface.curvature;
    const std::size_t count = surface.vertices.size();
    std::vector<ViewCurvature> view(count);
    parallel_for(
        count,
        [&](std::size_t i) {
            const Vec3 w = options.to_eye(surface.vertices[i]);
            view[i] = view_curvature(c.k1[i], c.k2[i], {c.e1[i].dot(w), c.e2[i].dot(w), surface.normals[i].dot(w)});
        },
        k_ridge_grain);

    std::vector<Slope> slopes(count);
    for (const Face& face : surface.faces)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::uint32_t i = face[corner], a = face[(corner + 1) % 3], b = face[(corner + 2) % 3];
            const auto seen = [&](std::uint32_t other) {
                const Vec3 step = surface.vertices[other] - surface.vertices[i];
                return Vec2(c.e1[i].dot(step), c.e2[i].dot(step));
            };
            add_slope(view[i], seen(a), seen(b), view[a].q, view[b].q, slopes[i]);
        }

    const float squared_unit = options.feature_size * options.feature_size;
    std::vector<LineField> field(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec2 direction = view[i].direction.normalized();
        const float slope = slopes[i].count ? slopes[i].sum / static_cast<float>(slopes[i].count) : 0.0f;
        field[i].value = 1;
        field[i].strength = view[i].q * squared_unit;
        field[i].margin = field[i].strength - options.thresholds.apparent_ridges;
        field[i].front = view[i].cosine;
        field[i].direction = slope * (direction.x() * c.e1[i] + direction.y() * c.e2[i]);
    }
    return field;
}

}  // namespace exemplar
