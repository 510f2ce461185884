#include "host/animation/gltf_nodes.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/SVD>

#include "host/mesh/io/io_text.h"

namespace exemplar::animation_io {
namespace {

using mesh_io::GltfReader;

[[noreturn]] void fail_tree(const GltfReader& gltf, std::uint32_t node) {
    gltf.fail(fmt::format("node {} has two parents or is its own ancestor", node));
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

/// Decomposes `linear`, by polar decomposition, into the rotation and axis scales whose product is nearest to it;
/// equal to it unless it shears.
void decompose(const Eigen::Matrix3d& linear, NodeTransform& transform, double& shear) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
    if (rotation.determinant() < 0) rotation.col(0) *= -1;
    Eigen::Matrix3d stretch = rotation.transpose() * linear;
    transform.rotation = Eigen::Quaterniond(rotation).normalized().cast<float>();
    transform.scale = stretch.diagonal().cast<float>();
    stretch.diagonal().setZero();
    shear = stretch.cwiseAbs().maxCoeff() / std::max(linear.cwiseAbs().maxCoeff(), 1e-300);
}

}  // namespace

GltfTree read_gltf_tree(const GltfReader& gltf) {
    const auto& nodes = gltf.model().nodes;
    GltfTree tree;
    tree.parent.assign(nodes.size(), k_invalid_index);
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        for (const int child : nodes[i].children) {
            gltf.item(nodes, child, "node");
            std::uint32_t& parent = tree.parent[static_cast<std::size_t>(child)];
            if (parent != k_invalid_index) fail_tree(gltf, static_cast<std::uint32_t>(child));
            parent = i;
        }
    std::vector<std::uint32_t> roots;
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
        if (tree.parent[i] == k_invalid_index) roots.push_back(i);
    tree.order = depth_first(gltf, roots);
    if (tree.order.size() < nodes.size()) {
        std::vector<bool> reached(nodes.size(), false);
        for (const std::uint32_t i : tree.order) reached[i] = true;
        fail_tree(gltf, static_cast<std::uint32_t>(std::ranges::find(reached, false) - reached.begin()));
    }
    tree.in_scene.assign(nodes.size(), false);
    for (const int root : gltf.root_nodes()) {
        gltf.item(nodes, root, "node");
        tree.in_scene[static_cast<std::size_t>(root)] = true;
    }
    for (const std::uint32_t i : tree.order)
        if (tree.parent[i] != k_invalid_index && tree.in_scene[tree.parent[i]]) tree.in_scene[i] = true;
    return tree;
}

NodeTransform read_gltf_transform(const GltfReader& gltf, int index, std::vector<std::string>& warnings) {
    constexpr double k_visible_shear = 1e-3;
    const tinygltf::Node& node = gltf.item(gltf.model().nodes, index, "node");
    gltf.check_transform(node, index);
    const auto vec3 = [](const std::vector<double>& v) -> Vec3 { return Vec3d(v[0], v[1], v[2]).cast<float>(); };
    NodeTransform transform;
    if (!node.matrix.empty()) {
        const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
        transform.translation = matrix.col(3).head<3>().cast<float>();
        double shear = 0;
        if (matrix.allFinite()) decompose(matrix.topLeftCorner<3, 3>(), transform, shear);
        if (shear > k_visible_shear)
            warnings.push_back(fmt::format("the matrix of node {} ({}) shears by {:.3g}, which was left out", index,
                                           mesh_io::quote(node.name), shear));
        return transform;
    }
    if (!node.translation.empty()) transform.translation = vec3(node.translation);
    if (!node.scale.empty()) transform.scale = vec3(node.scale);
    if (!node.rotation.empty()) {
        const Eigen::Vector4f q =
            Eigen::Vector4d(node.rotation[0], node.rotation[1], node.rotation[2], node.rotation[3]).cast<float>();
        transform.rotation = unit_quaternion(q[0], q[1], q[2], q[3]);
    }
    return transform;
}

Eigen::Quaternionf unit_quaternion(float x, float y, float z, float w) {
    const Eigen::Vector4d q(x, y, z, w);
    const double length = q.norm();
    if (length == 0) return Eigen::Quaternionf::Identity();
    const Eigen::Vector4f unit = (q / length).cast<float>();
    return {unit[3], unit[0], unit[1], unit[2]};
}

}  // namespace exemplar::animation_io
