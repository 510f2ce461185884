#include "host/parts/rigging/make_rig.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/mesh/editing/weld.h"
#include "host/parts/rigging/part_weights.h"

namespace exemplar {
namespace {

/// The largest part with a label; nothing for an empty name.
std::optional<std::uint32_t> part_of_root(const PartGraph& graph, const std::vector<std::string>& names,
                                          const std::string& root) {
    if (root.empty()) return {};
    std::optional<std::uint32_t> best;
    for (std::uint32_t p = 0; p < graph.parts.size(); ++p) {
        const std::int32_t label = graph.parts[p].label;
        if (label < 0 || names.at(static_cast<std::size_t>(label)) != root) continue;
        if (!best || graph.parts[p].area > graph.parts[*best].area) best = p;
    }
    if (!best) throw DataError(fmt::format("no part has the label '{}' of the root{}", root, suggestion(root, names)));
    return best;
}

/// Divides the strengths of boundaries by the costs of their labels.
void weaken_unlikely(const LabelPairCosts& costs, const std::vector<std::string>& names, PartGraph& graph) {
    const auto name_of_part = [&](std::uint32_t part) {
        const std::int32_t label = graph.parts[part].label;
        return label < 0 ? std::string() : names.at(static_cast<std::size_t>(label));
    };
    for (PartBoundary& boundary : graph.boundaries) {
        std::pair<std::string, std::string> labels(name_of_part(boundary.part[0]), name_of_part(boundary.part[1]));
        if (labels.first > labels.second) std::swap(labels.first, labels.second);
        const auto cost = costs.find(labels);
        if (cost != costs.end()) boundary.strength /= std::max(cost->second, 1e-3);
    }
}

/// Fills the nodes of a rig with the joints at rest, each relative to its parent.
void add_joint_nodes(const Skeleton& skeleton, Rig& rig) {
    rig.nodes.reserve(skeleton.joints.size());
    for (const Joint& joint : skeleton.joints) {
        RigNode node;
        node.name = joint.name;
        node.parent = joint.parent;
        const bool is_root = joint.parent == k_invalid_index;
        const Eigen::Matrix3f above = is_root ? Eigen::Matrix3f(Eigen::Matrix3f::Identity())
                                              : Eigen::Matrix3f(skeleton.joints[joint.parent].axes.transpose());
        const Vec3 origin = is_root ? Vec3(Vec3::Zero()) : skeleton.joints[joint.parent].head;
        node.rest.translation = above * (joint.head - origin);
        node.rest.rotation = Eigen::Quaternionf(Eigen::Matrix3f(above * joint.axes)).normalized();
        rig.nodes.push_back(node);
    }
}

}  // namespace

PartRig make_skeleton(const TriangleMesh& mesh, const std::vector<std::string>& names,
                      std::span<const std::int32_t> label, const RigOptions& options) {
    PartRig result;
    result.animation.rest = welded(mesh);
    const TriangleMesh& rest = result.animation.rest;
    result.graph = build_part_graph(rest, build_topology(rest), label);
    weaken_unlikely(options.costs, names, result.graph);
    result.skeleton = build_skeleton(rest, result.graph, part_of_root(result.graph, names, options.root));
    return result;
}

PartRig make_rig(const TriangleMesh& mesh, const std::vector<std::string>& names, std::span<const std::int32_t> label,
                 const RigOptions& options) {
    PartRig result = make_skeleton(mesh, names, label, options);
    Animation& animation = result.animation;
    result.mirror = name_parts(animation.rest, result.graph, names, options.swap_sides, result.skeleton);
    animation.kind = AnimationKind::skeleton;
    add_joint_nodes(result.skeleton, animation.rig);
    static_cast<Skin&>(animation.rig) =
        weights_of_parts(animation.rest, result.graph, result.skeleton, options.falloff);
    return result;
}

}  // namespace exemplar
