// Reads the hierarchy of the nodes of a glTF file.
#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>

#include "host/mesh/gltf/gltf_surface.h"
#include "host/mesh/topology.h"

namespace exemplar::mesh_io {
namespace {

[[noreturn]] void fail_tree(const GltfReader& gltf, std::uint32_t node) {
    gltf.fail(fmt::format("node {} has two parents or is its own ancestor", node));
}

std::vector<std::uint32_t> parents_of_nodes(const GltfReader& gltf) {
    const auto& nodes = gltf.model().nodes;
    std::vector<std::uint32_t> parents(nodes.size(), k_invalid_index);
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            gltf.item(nodes, child, "node");
            std::uint32_t& parent = parents[static_cast<std::size_t>(child)];
            if (parent != k_invalid_index) fail_tree(gltf, static_cast<std::uint32_t>(child));
            parent = i;
        }
    return parents;
}

/// Returns the nodes without parents: those of the default scene first.
std::vector<std::uint32_t> ordered_roots(const GltfReader& gltf, const std::vector<std::uint32_t>& parents) {
    std::vector<std::uint32_t> roots;
    std::vector<bool> listed(parents.size(), false);
    const auto add = [&](std::size_t node) {
        if (parents[node] == k_invalid_index && !listed[node]) roots.push_back(static_cast<std::uint32_t>(node));
        listed[node] = true;
    };
    for (const int root : gltf.root_nodes()) {
        gltf.item(gltf.model().nodes, root, "node");
        add(static_cast<std::size_t>(root));
    }
    for (std::size_t node = 0; node < parents.size(); ++node) add(node);
    return roots;
}

/// Returns the nodes depth first from the roots, children in the file's order.
std::vector<std::uint32_t> depth_first(const GltfReader& gltf, const std::vector<std::uint32_t>& roots) {
    const auto& nodes = gltf.model().nodes;
    std::vector<std::uint32_t> order, stack(roots.rbegin(), roots.rend());
    while (!stack.empty()) {
        const std::uint32_t node = stack.back();
        stack.pop_back();
        order.push_back(node);
        const std::vector<int>& children = nodes[node].children;
        for (auto child = children.rbegin(); child != children.rend(); ++child)
            stack.push_back(static_cast<std::uint32_t>(*child));
    }
    return order;
}

Affine3 local_transform(const tinygltf::Node& node) {
    Affine3 transform = Affine3::Identity();
    if (!node.matrix.empty()) {
        transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()).topRows<3>();
        return transform;
    }
    if (!node.translation.empty())
        transform.translate(Vec3d(node.translation[0], node.translation[1], node.translation[2]));
    if (!node.rotation.empty())
        transform.rotate(
            Eigen::Quaterniond(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]).normalized());
    if (!node.scale.empty()) transform.scale(Vec3d(node.scale[0], node.scale[1], node.scale[2]));
    return transform;
}

}  // namespace

GltfTree read_gltf_tree(const GltfReader& gltf) {
    const std::size_t count = gltf.model().nodes.size();
    GltfTree tree;
    tree.parent = parents_of_nodes(gltf);
    tree.order = depth_first(gltf, ordered_roots(gltf, tree.parent));
    if (tree.order.size() < count) {
        std::vector<bool> reached(count, false);
        for (const std::uint32_t i : tree.order) reached[i] = true;
        fail_tree(gltf, static_cast<std::uint32_t>(std::ranges::find(reached, false) - reached.begin()));
    }
    tree.in_scene.assign(count, false);
    for (const int root : gltf.root_nodes()) tree.in_scene[static_cast<std::size_t>(root)] = true;
    for (const std::uint32_t i : tree.order)
        if (tree.parent[i] != k_invalid_index && tree.in_scene[tree.parent[i]]) tree.in_scene[i] = true;
    return tree;
}

std::vector<Affine3> gltf_world_transforms(const GltfReader& gltf, const GltfTree& tree) {
    const auto& nodes = gltf.model().nodes;
    std::vector<Affine3> world(nodes.size());
    for (const std::uint32_t i : tree.order) {
        gltf.check_transform(nodes[i], static_cast<int>(i));
        const std::uint32_t parent = tree.parent[i];
        world[i] = local_transform(nodes[i]);
        if (parent != k_invalid_index) world[i] = world[parent] * world[i];
    }
    return world;
}

}  // namespace exemplar::mesh_io
