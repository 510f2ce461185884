#include "host/parts/prototype/glasses_hinge.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/parts/prototype/body_grid.h"
#include "host/parts/prototype/solid_distance.h"

namespace exemplar {
namespace {

constexpr float k_degree = std::numbers::pi_v<float> / 180;
/// The least height of a hinge and the largest radius, in mm.
constexpr float k_least_height = 6, k_largest_radius = 3;
/// The arm is measured in a slab of this thickness behind the cut, in mm.
constexpr float k_root_slab = 2;

Vec3 level_direction(const Vec3& v) {
    return unit_or_up(Vec3d(static_cast<double>(v.x()), 0, static_cast<double>(v.z())));
}

/// The centroid of the surface of an arm between an eighth and a third of its length.
Vec3 begin_of_arm(const GlassesParts& parts, std::size_t side) {
    const Vec3& root = parts.arm_root[side];
    const float length = (parts.arm_tip[side] - root).norm();
    Vec3 sum = Vec3::Zero();
    float weight = 0;
    for (const std::uint32_t f : parts.arm_faces[side]) {
        const Face& face = parts.mesh.faces[f];
        const Vec3 &a = parts.mesh.vertices[face[0]], &b = parts.mesh.vertices[face[1]],
                   &c = parts.mesh.vertices[face[2]];
        const Vec3 center = (a + b + c) / 3;
        const float away = (center - root).norm() / length;
        if (away < 0.125F || away > 0.33F) continue;
        const float area = (b - a).cross(c - a).norm();
        sum += area * center;
        weight += area;
    }
    return weight > 0 ? Vec3(sum / weight) : parts.arm_tip[side];
}

/// The angle from straight back to a level direction, outward positive, in degrees.
float spread_of(const Vec3& direction, std::size_t side) {
    return std::atan2(side == 0 ? direction.x() : -direction.x(), -direction.z()) / k_degree;
}

/// Sets the plane of the cut: its normal, and a point of it in `center`.
void place_cut(const GlassesParts& parts, std::size_t side, ArmCut& cut) {
    const Vec3 begin = level_direction(begin_of_arm(parts, side) - parts.arm_root[side]);
    cut.spread = spread_of(level_direction(parts.arm_tip[side] - parts.arm_root[side]), side);
    cut.turn_to_frame = std::clamp(90 + cut.spread, 0.0F, 180.0F);
    PinHinge& hinge = cut.hinge;
    hinge.center = parts.arm_root[side];
    hinge.back = -Vec3::UnitZ();
    if (spread_of(begin, side) > k_frontal_spread)
        hinge.back = begin;
    else
        hinge.center.z() = (parts.arm_root[0].z() + parts.arm_root[1].z()) / 2;
    const float sign = side == 0 ? 1.0F : -1.0F;
    hinge.inward = sign * Vec3(hinge.back.z(), 0, -hinge.back.x());
}

/// Fills `side`: half of how much farther the other faces are than the arm's, but at most the distance behind the cut.
void divide_body(const GlassesParts& parts, const ValueGrid& body, std::size_t side, ArmCut& cut) {
    std::vector<bool> is_arm(parts.mesh.face_count(), false);
    for (const std::uint32_t f : parts.arm_faces[side]) is_arm[f] = true;
    std::vector<std::uint32_t> rest;
    for (std::uint32_t f = 0; f < parts.mesh.face_count(); ++f)
        if (!is_arm[f]) rest.push_back(f);
    const SurfaceDistance own(parts.mesh, parts.arm_faces[side], 0.7F * body.cell);
    const SurfaceDistance others(parts.mesh, rest, 0.7F * body.cell);
    const float far = k_body_reach * body.cell;
    cut.side.assign(body.value.size(), -far);
    parallel_for(body.size[2], [&](std::size_t layer) {
        const auto z = static_cast<std::uint32_t>(layer);
        for (std::uint32_t y = 0; y < body.size[1]; ++y)
            for (std::uint32_t x = 0; x < body.size[0]; ++x) {
                const std::size_t node = body.index(x, y, z);
                const Vec3 p = body.position(x, y, z);
                const float behind = (p - cut.hinge.center).dot(cut.hinge.back);
                if (body.value[node] >= far || behind <= -far) continue;
                cut.side[node] = std::min(behind, (others(p) - own(p)) / 2);
            }
    });
}

/// The box of the arm's inside in a slab behind the cut, in the coordinates of the hinge.
struct RootBox {
    Vec3 low = Vec3::Constant(1e30F), high = Vec3::Constant(-1e30F);
    std::size_t nodes = 0;
};

RootBox measure_root(const ValueGrid& body, const ArmCut& cut) {
    RootBox box;
    for (std::uint32_t z = 0; z < body.size[2]; ++z)
        for (std::uint32_t y = 0; y < body.size[1]; ++y)
            for (std::uint32_t x = 0; x < body.size[0]; ++x) {
                const std::size_t node = body.index(x, y, z);
                if (body.value[node] > 0 || cut.side[node] <= 0) continue;
                const Vec3 p = cut.hinge.local(body.position(x, y, z));
                if (p.z() > k_root_slab || p.head<2>().norm() > 25) continue;
                box.low = box.low.cwiseMin(p);
                box.high = box.high.cwiseMax(p);
                ++box.nodes;
            }
    return box;
}

/// Whether a vertex of `mesh`, turned about the hinge, is inside of the values.
bool touches(const TriangleMesh& mesh, const PinHinge& hinge, float angle, const ValueGrid& values) {
    const Vec3 low = values.origin, high = values.position(values.size[0] - 1, values.size[1] - 1, values.size[2] - 1);
    std::atomic<bool> any = false;
    parallel_ranges(mesh.vertices.size(), 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t v = begin; v < end && !any; ++v) {
            const Vec3 p = hinge.turned(mesh.vertices[v], angle);
            if ((p - low).minCoeff() < 0 || (high - p).minCoeff() < 0) continue;
            if (value_at(values, p) < 0) any = true;
        }
    });
    return any;
}

}  // namespace

std::pair<Vec2, Vec2> ArmCut::footprint() const {
    Vec2 low = Vec2::Constant(1e30F), high = -low;
    const float reach = 2.2F * hinge.radius + hinge.gap;
    for (const float u : {-hinge.radius - hinge.arm_width, hinge.radius + hinge.gap})
        for (const float b : {-reach, hinge.radius}) {
            const Vec2 p = (hinge.center + u * hinge.inward + b * hinge.back).head<2>();
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    low.y() = hinge.center.y() - hinge.height / 2;
    high.y() = hinge.center.y() + hinge.height / 2;
    return {low, high};
}

ArmCut cut_arm(const GlassesParts& parts, const ValueGrid& body, std::size_t side, float gap) {
    ArmCut cut;
    PinHinge& hinge = cut.hinge;
    hinge.gap = gap;
    place_cut(parts, side, cut);
    divide_body(parts, body, side, cut);
    const RootBox root = measure_root(body, cut);
    if (root.nodes == 0)
        throw MeshError(fmt::format("its {} arm is too thin at its root for this width and resolution",
                                    side == 0 ? "left" : "right"));
    hinge.arm_width = root.high.x() - root.low.x();
    const float least = smallest_hinge(gap);
    hinge.radius = std::clamp(hinge.arm_width / 2, least, std::max(least, k_largest_radius));
    hinge.pin_radius = pin_of_hinge(hinge.radius, gap);
    hinge.height = std::max(root.high.y() - root.low.y(), k_least_height + 2 * gap);
    hinge.center += (root.high.x() + hinge.radius) * hinge.inward;
    hinge.center.y() += (root.high.y() + root.low.y()) / 2;
    return cut;
}

float free_turn(const GlassesArm& arm, const MovingSolid& moving, const std::vector<const TriangleMesh*>& meshes,
                const std::vector<ValueGrid>& values) {
    constexpr float k_step = 3;
    for (float degrees = 0;; degrees = std::min(degrees + k_step, arm.wanted)) {
        check_interrupt();
        for (std::size_t i = 0; i < meshes.size(); ++i)
            if (touches(*moving.mesh, arm.hinge, degrees * k_degree, values[i]) ||
                touches(*meshes[i], arm.hinge, -degrees * k_degree, *moving.values))
                return std::max(degrees - k_step, 0.0F);
        if (degrees >= arm.wanted) return arm.wanted;
    }
}

}  // namespace exemplar
