#include "host/animation/gltf_nodes.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <Eigen/SVD>

#include "host/mesh/io/io_text.h"

namespace exemplar::animation_io {
namespace {

using mesh_io::GltfReader;

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
