#include "host/parts/rigging/skeleton.h"

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/mesh/queries/axes.h"

namespace exemplar {
namespace {

/// Bones that meet at less than this angle (its sine: 15 degrees) have no hinge of their own.
constexpr float k_straight_sine = 0.26F;
/// A tail nearer to the head than this share of the part's reach is no direction.
constexpr float k_shortest_bone = 0.15F;

std::uint32_t largest_part(const PartGraph& graph) {
    const auto largest = std::max_element(graph.parts.begin(), graph.parts.end(),
                                          [](const Part& a, const Part& b) { return a.area < b.area; });
    return static_cast<std::uint32_t>(largest - graph.parts.begin());
}

/// Whether a tree rather follows boundary `a` than `b`: parts of equal label, two legs that touch, hang on each other
/// only if nothing else connects them; else the stronger boundary.
bool is_stronger(const PartGraph& graph, const PartBoundary& a, const PartBoundary& b) {
    const auto is_alike = [&](const PartBoundary& boundary) {
        return graph.parts[boundary.part[0]].label == graph.parts[boundary.part[1]].label;
    };
    return is_alike(a) != is_alike(b) ? is_alike(b) : a.strength > b.strength;
}

/// Adds the parts in the order of Prim's algorithm: always along the strongest boundary to a part that is new.
void grow_tree(const PartGraph& graph, Skeleton& skeleton) {
    while (skeleton.joints.size() < graph.parts.size()) {
        std::uint32_t best = k_invalid_index;
        for (std::uint32_t b = 0; b < graph.boundaries.size(); ++b) {
            const auto [p, q] = graph.boundaries[b].part;
            if ((skeleton.joint_of_part[p] == k_invalid_index) == (skeleton.joint_of_part[q] == k_invalid_index))
                continue;
            if (best == k_invalid_index || is_stronger(graph, graph.boundaries[b], graph.boundaries[best])) best = b;
        }
        if (best == k_invalid_index) throw MeshError("its parts are not connected");
        const auto [p, q] = graph.boundaries[best].part;
        const bool p_is_new = skeleton.joint_of_part[p] == k_invalid_index;
        Joint joint;
        joint.part = p_is_new ? p : q;
        joint.parent = skeleton.joint_of_part[p_is_new ? q : p];
        joint.boundary = best;
        joint.head = graph.boundaries[best].center;
        skeleton.joint_of_part[joint.part] = static_cast<std::uint32_t>(skeleton.joints.size());
        skeleton.joints.push_back(joint);
    }
}

/// The vertices of each joint's part that are far from its head.
struct PartTips {
    std::vector<float> reach;  ///< largest distance from the head
    std::vector<Vec3> tip;     ///< mean of the corners at more than 0.95 of it
};

PartTips tips_of(const TriangleMesh& mesh, const PartGraph& graph, const Skeleton& skeleton) {
    const std::size_t count = skeleton.joints.size();
    PartTips tips{std::vector<float>(count, 0), std::vector<Vec3>(count, Vec3::Zero())};
    std::vector<float> corners(count, 0);
    const auto each_corner = [&](const auto& body) {
        for (std::size_t f = 0; f < mesh.face_count(); ++f) {
            const std::uint32_t joint = skeleton.joint_of_part[graph.part_of_face[f]];
            for (const std::uint32_t v : mesh.faces[f])
                body(joint, mesh.vertices[v], (mesh.vertices[v] - skeleton.joints[joint].head).norm());
        }
    };
    each_corner([&](std::uint32_t joint, const Vec3&, float distance) {
        tips.reach[joint] = std::max(tips.reach[joint], distance);
    });
    each_corner([&](std::uint32_t joint, const Vec3& position, float distance) {
        if (distance < 0.95F * tips.reach[joint]) return;
        tips.tip[joint] += position;
        corners[joint] += 1;
    });
    for (std::size_t j = 0; j < count; ++j) tips.tip[j] /= corners[j];
    return tips;
}

/// Ends each bone at the mean of the joints of its children, weighted by boundary, else at the tip of the part.
void set_tails(const TriangleMesh& mesh, const PartGraph& graph, Skeleton& skeleton) {
    std::vector<Vec3> sum(skeleton.joints.size(), Vec3::Zero());
    std::vector<float> weight(skeleton.joints.size(), 0);
    for (const Joint& joint : skeleton.joints) {
        if (joint.parent == k_invalid_index) continue;
        const auto length = static_cast<float>(graph.boundaries[joint.boundary].length);
        sum[joint.parent] += length * joint.head;
        weight[joint.parent] += length;
    }
    const PartTips tips = tips_of(mesh, graph, skeleton);
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        Joint& joint = skeleton.joints[j];
        joint.tail = weight[j] > 0 ? Vec3(sum[j] / weight[j]) : tips.tip[j];
        if ((joint.tail - joint.head).norm() < k_shortest_bone * tips.reach[j]) joint.tail = tips.tip[j];
    }
}

/// The principal axis that is most across `direction`, made normal to it.
Vec3 axis_across(const PrincipalAxes& axes, const Vec3& direction) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < 3; ++i)
        if (std::abs(axes.axis[i].dot(direction)) < std::abs(axes.axis[best].dot(direction)) - 1e-3F) best = i;
    return (axes.axis[best] - axes.axis[best].dot(direction) * direction).normalized();
}

void set_axes(const TriangleMesh& mesh, Skeleton& skeleton) {
    const PrincipalAxes principal = principal_axes(mesh);
    for (Joint& joint : skeleton.joints) {
        joint.axes = Eigen::Matrix3f::Identity();
        if (joint.parent == k_invalid_index) continue;
        const Joint& parent = skeleton.joints[joint.parent];
        const Vec3 bone = unit_or_up((joint.tail - joint.head).cast<double>());
        Vec3 hinge = unit_or_up((parent.tail - parent.head).cast<double>()).cross(bone);
        if (parent.parent == k_invalid_index || hinge.norm() < k_straight_sine) hinge = axis_across(principal, bone);
        joint.axes.col(0) = hinge.normalized();
        joint.axes.col(1) = bone;
        joint.axes.col(2) = joint.axes.col(0).cross(bone);
    }
}

}  // namespace

Skeleton build_skeleton(const TriangleMesh& mesh, const PartGraph& graph, std::optional<std::uint32_t> root) {
    Skeleton skeleton;
    skeleton.joint_of_part.assign(graph.parts.size(), k_invalid_index);
    Joint first;
    first.part = root.value_or(largest_part(graph));
    first.head = graph.parts.at(first.part).center;
    skeleton.joint_of_part[first.part] = 0;
    skeleton.joints.reserve(graph.parts.size());
    skeleton.joints.push_back(first);
    grow_tree(graph, skeleton);
    set_tails(mesh, graph, skeleton);
    set_axes(mesh, skeleton);
    return skeleton;
}

}  // namespace exemplar
