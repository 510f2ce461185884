#include "host/parts/prototype/mannequin.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/parts/prototype/level_surface.h"
#include "host/parts/prototype/solid_distance.h"

namespace exemplar {
namespace {

/// The largest radius of a ball, in radii of the boundary.
constexpr float k_ball_share = 0.6F;

/// The mesh in mm, with its corner at the origin.
TriangleMesh scaled_to_print(const TriangleMesh& mesh, double height) {
    TriangleMesh print = closed_for_print(mesh);
    const BoundingBox box = bounding_box(print);
    const auto scale = static_cast<float>(height / (box.high - box.low).maxCoeff());
    const Vec3 low = box.low.cast<float>();
    for (Vec3& v : print.vertices) v = scale * (v - low);
    print.origin.setZero();
    return print;
}

/// The figure in mm and what its solids are made of.
struct PrintPlan {
    TriangleMesh mesh;
    PartGraph graph;
    Skeleton skeleton;
    std::vector<PrintJoint> joints;
    std::vector<std::uint32_t> solid_of_part;
    std::vector<std::string> name_of_solid;
    ValueGrid lattice;  ///< its values are not used
    std::vector<bool> inside;
    float gap = 0;
};

void set_lattice(const MannequinOptions& options, PrintPlan& plan) {
    const BoundingBox box = bounding_box(plan.mesh);
    plan.lattice.cell = static_cast<float>(options.height / static_cast<double>(options.resolution));
    plan.lattice.origin = box.low.cast<float>() - Vec3::Constant(3 * plan.lattice.cell);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        plan.lattice.size[axis] = static_cast<std::uint32_t>((box.high[a] - box.low[a]) / plan.lattice.cell) + 8;
    }
    plan.inside = nodes_inside(plan.mesh, plan.lattice.size, plan.lattice.origin, plan.lattice.cell);
}

bool is_inside(const PrintPlan& plan, const Vec3& point) {
    std::array<std::uint32_t, 3> node{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        const float at = std::round((point[a] - plan.lattice.origin[a]) / plan.lattice.cell);
        if (at < 0 || at >= static_cast<float>(plan.lattice.size[axis])) return false;
        node[axis] = static_cast<std::uint32_t>(at);
    }
    return plan.inside[plan.lattice.index(node[0], node[1], node[2])];
}

/// A joint with the largest ball whose socket fits into the parent with a wall of one gap; fused if there is none.
PrintJoint fitted_joint(const PrintPlan& plan, const SurfaceDistance& surface, std::uint32_t j, PrintJointKind kind) {
    const Joint& child = plan.skeleton.joints[j];
    const Joint& parent = plan.skeleton.joints[child.parent];
    PrintJoint joint;
    joint.joint = j;
    joint.kind = kind;
    const bool is_leaf_like = (child.tail - child.head).norm() > 0;
    joint.inward =
        is_leaf_like ? Vec3((child.head - child.tail).normalized()) : Vec3((parent.head - child.head).normalized());
    joint.hinge = child.axes.col(0);
    const double length = plan.graph.boundaries[child.boundary].length;
    const float largest = k_ball_share * static_cast<float>(length / (2 * std::numbers::pi));
    for (float radius = largest; radius >= 2 * plan.gap; radius *= 0.93F) {
        joint.radius = radius;
        joint.center = child.head + k_ball_depth * radius * joint.inward;
        const float room = kind == PrintJointKind::hinge ? 1.35F * radius : radius;
        if (is_inside(plan, joint.center) && surface(joint.center) >= room + 2 * plan.gap) return joint;
    }
    joint.kind = PrintJointKind::fused;
    joint.radius = 0;
    return joint;
}

/// Shrinks balls that would meet, and fuses those that become too small.
void separate_joints(PrintPlan& plan) {
    for (std::size_t i = 0; i < plan.joints.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            PrintJoint &a = plan.joints[i], &b = plan.joints[k];
            if (a.kind == PrintJointKind::fused || b.kind == PrintJointKind::fused) continue;
            const float room = (a.center - b.center).norm() - 3 * plan.gap;
            const float reach = 1.35F * (a.radius + b.radius);
            if (reach <= room) continue;
            for (PrintJoint* joint : {&a, &b}) {
                const float radius = joint->radius * std::max(room / reach, 0.0F);
                joint->center += k_ball_depth * (radius - joint->radius) * joint->inward;
                joint->radius = radius;
                if (radius < 2 * plan.gap) joint->kind = PrintJointKind::fused;
            }
        }
}

void plan_joints(const std::vector<std::string>& names, const MannequinOptions& options, PrintPlan& plan) {
    std::vector<std::uint32_t> all(plan.mesh.face_count());
    for (std::uint32_t f = 0; f < all.size(); ++f) all[f] = f;
    const SurfaceDistance surface(plan.mesh, all, plan.lattice.cell);
    for (std::uint32_t j = 1; j < plan.skeleton.joints.size(); ++j) {
        check_interrupt();
        const std::int32_t label = plan.graph.parts[plan.skeleton.joints[j].part].label;
        const bool is_hinge = label >= 0 && std::find(options.hinges.begin(), options.hinges.end(),
                                                      names[static_cast<std::size_t>(label)]) != options.hinges.end();
        plan.joints.push_back(fitted_joint(plan, surface, j, is_hinge ? PrintJointKind::hinge : PrintJointKind::ball));
    }
    separate_joints(plan);
}

/// Numbers the solids: parts that fused joints connect are one, named after the first joint.
void number_solids(PrintPlan& plan) {
    DisjointSets sets(plan.graph.parts.size());
    for (const PrintJoint& joint : plan.joints) {
        const Joint& child = plan.skeleton.joints[joint.joint];
        if (joint.kind == PrintJointKind::fused) sets.join(child.part, plan.skeleton.joints[child.parent].part);
    }
    std::vector<std::uint32_t> number(plan.graph.parts.size(), k_invalid_index);
    plan.solid_of_part.resize(plan.graph.parts.size());
    for (const Joint& joint : plan.skeleton.joints) {
        std::uint32_t& solid = number[sets.find(joint.part)];
        if (solid == k_invalid_index) {
            solid = static_cast<std::uint32_t>(plan.name_of_solid.size());
            plan.name_of_solid.push_back(joint.name);
        }
        plan.solid_of_part[joint.part] = solid;
    }
}

/// The joints at one solid: those whose balls it carries, and those whose sockets it has.
struct SolidJoints {
    std::vector<const PrintJoint*> balls, sockets;
};

SolidJoints joints_of_solid(const PrintPlan& plan, std::uint32_t solid) {
    SolidJoints joints;
    for (const PrintJoint& joint : plan.joints) {
        if (joint.kind == PrintJointKind::fused) continue;
        const Joint& child = plan.skeleton.joints[joint.joint];
        if (plan.solid_of_part[child.part] == solid) joints.balls.push_back(&joint);
        if (plan.solid_of_part[plan.skeleton.joints[child.parent].part] == solid) joints.sockets.push_back(&joint);
    }
    return joints;
}

/// The part of the lattice around a solid and its balls.
ValueGrid grid_of_solid(const PrintPlan& plan, const std::vector<std::uint32_t>& faces, const SolidJoints& joints,
                        std::array<std::uint32_t, 3>& first) {
    Vec3 low = plan.mesh.vertices[plan.mesh.faces[faces[0]][0]], high = low;
    const auto include = [&](const Vec3& p, float margin) {
        low = low.cwiseMin(p - Vec3::Constant(margin));
        high = high.cwiseMax(p + Vec3::Constant(margin));
    };
    for (const std::uint32_t f : faces)
        for (const std::uint32_t v : plan.mesh.faces[f]) include(plan.mesh.vertices[v], 0);
    for (const PrintJoint* joint : joints.balls) include(joint->center, 1.5F * joint->radius);
    ValueGrid grid;
    grid.cell = plan.lattice.cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<Eigen::Index>(axis);
        const float from = (low[a] - plan.lattice.origin[a]) / grid.cell - 2,
                    to = (high[a] - plan.lattice.origin[a]) / grid.cell + 3;
        first[axis] = static_cast<std::uint32_t>(std::max(from, 0.0F));
        grid.size[axis] = std::min(static_cast<std::uint32_t>(to) + 1, plan.lattice.size[axis]) - first[axis];
    }
    grid.origin = plan.lattice.position(first[0], first[1], first[2]);
    grid.value.resize(std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]);
    return grid;
}

/// The value of a solid at a point, given the distances to its own surface and to that of the others.
float solid_value(const PrintPlan& plan, const SolidJoints& joints, const Vec3& p, bool inside, float own,
                  float others) {
    const float distance = std::min(own, others);
    float value = inside ? -distance : distance;
    value = std::max(value, (own - others + plan.gap) / 2);
    for (const PrintJoint* joint : joints.sockets) value = std::max(value, -joint->head_distance(p, plan.gap));
    for (const PrintJoint* joint : joints.balls)
        value = std::min({value, joint->head_distance(p, 0), joint->pin_distance(p)});
    return value;
}

TriangleMesh solid_mesh(const PrintPlan& plan, std::uint32_t solid) {
    std::vector<std::uint32_t> own_faces, other_faces;
    for (std::uint32_t f = 0; f < plan.mesh.face_count(); ++f)
        (plan.solid_of_part[plan.graph.part_of_face[f]] == solid ? own_faces : other_faces).push_back(f);
    const SurfaceDistance own(plan.mesh, own_faces, 0.7F * plan.lattice.cell);
    std::unique_ptr<SurfaceDistance> others;
    if (!other_faces.empty())
        others = std::make_unique<SurfaceDistance>(plan.mesh, other_faces, 0.7F * plan.lattice.cell);
    const SolidJoints joints = joints_of_solid(plan, solid);
    std::array<std::uint32_t, 3> first{};
    ValueGrid grid = grid_of_solid(plan, own_faces, joints, first);
    parallel_for(grid.size[2], [&](std::size_t z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y)
            for (std::uint32_t x = 0; x < grid.size[0]; ++x) {
                const auto layer = static_cast<std::uint32_t>(z);
                const Vec3 p = grid.position(x, y, layer);
                const bool inside = plan.inside[plan.lattice.index(x + first[0], y + first[1], layer + first[2])];
                grid.value[grid.index(x, y, layer)] =
                    solid_value(plan, joints, p, inside, own(p), others ? (*others)(p) : 1e9F);
            }
    });
    return without_crumbs(level_surface(grid));
}

}  // namespace

Mannequin make_mannequin(const TriangleMesh& mesh, const std::vector<std::string>& names,
                         std::span<const std::int32_t> label, const MannequinOptions& options) {
    PrintPlan plan;
    const TriangleMesh print = scaled_to_print(mesh, options.height);
    PartRig rig = make_skeleton(print, names, label, {.root = options.root, .costs = options.costs});
    plan.mesh = std::move(rig.animation.rest);
    plan.graph = std::move(rig.graph);
    plan.skeleton = std::move(rig.skeleton);
    plan.gap = static_cast<float>(options.gap);
    name_parts(plan.mesh, plan.graph, names, false, plan.skeleton);
    set_lattice(options, plan);
    plan_joints(names, options, plan);
    number_solids(plan);
    Mannequin mannequin;
    Progress progress("making solids", plan.name_of_solid.size());
    for (std::uint32_t solid = 0; solid < plan.name_of_solid.size(); ++solid) {
        check_interrupt();
        mannequin.solids.push_back({plan.name_of_solid[solid], solid_mesh(plan, solid)});
        if (mannequin.solids.back().mesh.faces.empty())
            throw MeshError(
                fmt::format("its part '{}' is too thin for this resolution and gap", plan.name_of_solid[solid]));
        progress.advance(1, plan.name_of_solid[solid]);
    }
    mannequin.joints = std::move(plan.joints);
    mannequin.skeleton = std::move(plan.skeleton);
    mannequin.cell = plan.lattice.cell;
    return mannequin;
}

}  // namespace exemplar
