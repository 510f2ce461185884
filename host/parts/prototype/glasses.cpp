#include "host/parts/prototype/glasses.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/parts/prototype/body_grid.h"
#include "host/parts/prototype/glasses_hinge.h"
#include "host/parts/prototype/glasses_parts.h"
#include "host/parts/prototype/lens_outline.h"
#include "host/parts/prototype/print_shapes.h"

namespace exemplar {
namespace {

constexpr std::array<const char*, 2> k_side_names{"left", "right"};

/// The plane of a lens: the point where it crosses the z axis, and its axes.
struct LensPlane {
    Vec3 point;
    Vec3 normal, right, up;  ///< orthonormal; `right` is level
};

/// Everything that the solids are made of.
struct GlassesPlan {
    GlassesParts parts;
    ValueGrid body;
    std::array<ArmCut, 2> cuts;
    std::array<OutlineGrid, 2> openings;  ///< negative in the opening of each lens, seen along z
    std::array<LensPlane, 2> planes;
    float gap = 0, sheet = 0;
};

/// The least squares plane of the centers of the faces of a lens, weighted by their projected areas.
LensPlane plane_of_lens(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Vec3d b = Vec3d::Zero();
    for (const std::uint32_t f : faces) {
        const Vec3 &p = mesh.vertices[mesh.faces[f][0]], &q = mesh.vertices[mesh.faces[f][1]],
                   &r = mesh.vertices[mesh.faces[f][2]];
        const auto weight = static_cast<double>(std::abs((q - p).cross(r - p).z()));
        const Vec3d center = ((p + q + r) / 3).cast<double>();
        const Vec3d row(center.x(), center.y(), 1);
        a += weight * row * row.transpose();
        b += weight * center.z() * row;
    }
    const Vec3d fit = a.ldlt().solve(b);
    LensPlane plane;
    plane.normal = Vec3d(-fit.x(), -fit.y(), 1).normalized().cast<float>();
    plane.right = Vec3::UnitY().cross(plane.normal).normalized();
    plane.up = plane.normal.cross(plane.right);
    plane.point = Vec3(0, 0, static_cast<float>(fit.z()));
    return plane;
}

/// The opening of a lens: the silhouette less the rim, kept away from the brackets of the hinge.
OutlineGrid opening_of_lens(const GlassesPlan& plan, std::size_t side, float rim) {
    const float sign = side == 0 ? 1.0F : -1.0F;
    OutlineGrid grid = silhouette_distances(plan.parts.mesh, plan.parts.lens_faces[side], plan.body.cell / 2,
                                            [&](const Vec2& p) { return sign * p.x() > 0; });
    const auto footprint = plan.cuts[side].footprint();
    const Vec2 inset = Vec2::Constant(rim / 2).cwiseMin((footprint.second - footprint.first) / 2);
    const Vec2 low = footprint.first + inset, high = footprint.second - inset;
    for (std::uint32_t y = 0; y < grid.height; ++y)
        for (std::uint32_t x = 0; x < grid.width; ++x) {
            const Vec2 p = grid.position(x, y);
            const float bracket = box_distance({p.x(), p.y(), 0}, {low.x(), low.y(), -rim}, {high.x(), high.y(), rim});
            float& value = grid.value[grid.index(x, y)];
            value = std::max(value + rim, rim - bracket);
        }
    keep_largest_area(grid);
    if (std::none_of(grid.value.begin(), grid.value.end(), [](float v) { return v < 0; }))
        throw MeshError(
            fmt::format("its {} lens has no opening within a rim of {:g} mm; make --width larger or --rim smaller",
                        k_side_names[side], static_cast<double>(rim)));
    return grid;
}

GlassesPlan plan_glasses(const TriangleMesh& mesh, const std::vector<std::string>& names,
                         std::span<const std::int32_t> label, const GlassesOptions& options) {
    GlassesPlan plan;
    plan.parts = glasses_parts(mesh, label, glasses_labels(names, options.lens, options.arm), options.width);
    plan.gap = static_cast<float>(options.gap);
    plan.sheet = static_cast<float>(options.sheet);
    const auto cell = static_cast<float>(options.width / static_cast<double>(options.resolution));
    plan.body = body_distances(plan.parts.mesh, cell, 4 + 3 * cell);
    check_interrupt();
    for (std::size_t side = 0; side < 2; ++side) plan.cuts[side] = cut_arm(plan.parts, plan.body, side, plan.gap);
    for (std::size_t side = 0; side < 2; ++side) {
        plan.planes[side] = plane_of_lens(plan.parts.mesh, plan.parts.lens_faces[side]);
        plan.openings[side] = opening_of_lens(plan, side, static_cast<float>(options.rim));
    }
    return plan;
}

using SolidValue = std::function<float(const Vec3& point, std::size_t node)>;

/// Fills the part of the body's grid between two corners with the values of a solid; positive at its border.
ValueGrid grid_of_values(const ValueGrid& body, const Vec3& low, const Vec3& high, const SolidValue& value) {
    ValueGrid grid;
    grid.cell = body.cell;
    std::array<std::uint32_t, 3> first{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        first[axis] = static_cast<std::uint32_t>(std::max((low[a] - body.origin[a]) / body.cell - 2, 0.0F));
        const auto last = static_cast<std::uint32_t>(std::max((high[a] - body.origin[a]) / body.cell + 3, 0.0F));
        grid.size[axis] = std::min(last + 1, body.size[axis]) - first[axis];
    }
    grid.origin = body.position(first[0], first[1], first[2]);
    grid.value.resize(std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]);
    parallel_for(grid.size[2], [&](std::size_t layer) {
        const auto z = static_cast<std::uint32_t>(layer);
        for (std::uint32_t y = 0; y < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const bool is_border = x == 0 || y == 0 || z == 0 || x + 1 == grid.size[0] || y + 1 == grid.size[1] ||
                                       z + 1 == grid.size[2];
                const float v = value(grid.position(x, y, z), body.index(x + first[0], y + first[1], z + first[2]));
                grid.value[grid.index(x, y, z)] = is_border ? std::max(v, 0.1F * grid.cell) : v;
            }
    });
    return grid;
}

ValueGrid frame_values(const GlassesPlan& plan) {
    const Vec3 far = plan.body.position(plan.body.size[0], plan.body.size[1], plan.body.size[2]);
    return grid_of_values(plan.body, plan.body.origin, far, [&](const Vec3& p, std::size_t node) {
        float value = plan.body.value[node];
        for (std::size_t side = 0; side < 2; ++side) {
            const ArmCut& cut = plan.cuts[side];
            value = std::max(value, cut.side[node] + plan.gap / 2);
            value = std::max(value, -plan.openings[side](p.head<2>()));
            value = std::max(value, -cut.hinge.room_of_arm(p));
            value = std::min(value, cut.hinge.frame_part(p));
        }
        return value;
    });
}

ValueGrid arm_values(const GlassesPlan& plan, std::size_t side) {
    Vec3 low = plan.cuts[side].hinge.center, high = low;
    for (const std::uint32_t f : plan.parts.arm_faces[side])
        for (const std::uint32_t v : plan.parts.mesh.faces[f]) {
            low = low.cwiseMin(plan.parts.mesh.vertices[v]);
            high = high.cwiseMax(plan.parts.mesh.vertices[v]);
        }
    const ArmCut& cut = plan.cuts[side];
    const Vec3 reach = Vec3::Constant(cut.hinge.height + cut.hinge.radius);
    low = low.cwiseMin(cut.hinge.center - reach);
    high = high.cwiseMax(cut.hinge.center + reach);
    return grid_of_values(plan.body, low, high, [&](const Vec3& p, std::size_t node) {
        float value = std::max(plan.body.value[node], plan.gap / 2 - cut.side[node]);
        value = std::min(value, cut.hinge.arm_part(p));
        return std::max(value, -cut.hinge.room_of_frame(p));
    });
}

/// How much a lens is smaller than its opening: the gap, and what its edges, which are square to the sheet, take up.
float margin_of_lens(const GlassesPlan& plan, std::size_t side) {
    const Vec3& normal = plan.planes[side].normal;
    return plan.gap + plan.sheet / 2 * normal.head<2>().norm() / std::max(normal.z(), 0.1F);
}

ValueGrid lens_values(const GlassesPlan& plan, std::size_t side) {
    const LensPlane& plane = plan.planes[side];
    const OutlineGrid& opening = plan.openings[side];
    const float margin = margin_of_lens(plan, side);
    const Vec2 far = opening.position(opening.width, opening.height);
    const Vec3 low(opening.origin.x(), opening.origin.y(), plan.body.origin.z());
    const Vec3 high(far.x(), far.y(), plan.body.position(0, 0, plan.body.size[2]).z());
    return grid_of_values(plan.body, low, high, [&](const Vec3& p, std::size_t) {
        const float height = (p - plane.point).dot(plane.normal);
        const Vec3 foot = p - height * plane.normal;
        return std::max(opening(foot.head<2>()) + margin, std::abs(height) - plan.sheet / 2);
    });
}

/// The outline of a lens in its own plane, around the middle of its box.
std::vector<std::vector<Vec2>> outline_of_lens(const GlassesPlan& plan, std::size_t side) {
    OutlineGrid smaller = plan.openings[side];
    const float margin = margin_of_lens(plan, side);
    for (float& v : smaller.value) v += margin;
    keep_largest_area(smaller);
    const LensPlane& plane = plan.planes[side];
    std::vector<std::vector<Vec2>> outline = outlines_of(smaller);
    Vec2 low = Vec2::Constant(1e30F), high = -low;
    for (std::vector<Vec2>& loop : outline)
        for (Vec2& p : loop) {
            const Vec3 level = Vec3(p.x(), p.y(), 0) - plane.point;
            const Vec3 place = level - level.dot(plane.normal) / plane.normal.z() * Vec3::UnitZ();
            p = Vec2(place.dot(plane.right), place.dot(plane.up));
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    for (std::vector<Vec2>& loop : outline)
        for (Vec2& p : loop) p -= (low + high) / 2;
    return outline;
}

PrintSolid solid_of_grid(const std::string& name, const ValueGrid& grid) {
    PrintSolid solid{name, without_crumbs(level_surface(grid))};
    if (solid.mesh.faces.empty())
        throw MeshError(fmt::format("its {} is too thin for this width and resolution", name));
    return solid;
}

}  // namespace

Glasses make_glasses(const TriangleMesh& mesh, const std::vector<std::string>& names,
                     std::span<const std::int32_t> label, const GlassesOptions& options) {
    const GlassesPlan plan = plan_glasses(mesh, names, label, options);
    Glasses glasses;
    glasses.cell = plan.body.cell;
    Progress progress("making solids", 5);
    std::vector<ValueGrid> still{frame_values(plan)};
    glasses.solids.push_back(solid_of_grid("frame", still[0]));
    progress.advance(1, "frame");
    for (std::size_t side = 0; side < 2; ++side) {
        const std::string name = fmt::format("lens_{}", k_side_names[side]);
        still.push_back(lens_values(plan, side));
        glasses.solids.push_back(solid_of_grid(name, still.back()));
        glasses.lenses[side] = {name, outline_of_lens(plan, side)};
        progress.advance(1, name);
    }
    for (std::size_t side = 0; side < 2; ++side) {
        GlassesArm& arm = glasses.arms[side];
        arm.name = fmt::format("arm_{}", k_side_names[side]);
        arm.hinge = plan.cuts[side].hinge;
        arm.spread = plan.cuts[side].spread;
        arm.wanted = plan.cuts[side].turn_to_frame;
        const ValueGrid grid = arm_values(plan, side);
        glasses.solids.push_back(solid_of_grid(arm.name, grid));
        std::vector<const TriangleMesh*> meshes;
        for (std::size_t i = 0; i < 3; ++i) meshes.push_back(&glasses.solids[i].mesh);
        arm.turns = free_turn(arm, {&glasses.solids.back().mesh, &grid}, meshes, still);
        progress.advance(1, arm.name);
    }
    progress.finish();
    return glasses;
}

}  // namespace exemplar
