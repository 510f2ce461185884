#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/mesh/io/io_gltf_reader.h"

namespace exemplar::animation_io {

/// The hierarchy of the nodes of a glTF file.
struct GltfTree {
    std::vector<std::uint32_t> parent;  ///< per node; k_invalid_index at a root
    std::vector<std::uint32_t> order;   ///< all nodes, parents before children
    std::vector<bool> in_scene;         ///< per node: whether it is in the default scene
};

/// Reads the hierarchy. Throws MeshError if a node has two parents or is its own ancestor.
GltfTree read_gltf_tree(const mesh_io::GltfReader& gltf);

/// Reads the transform of node `index` relative to its parent. Decomposes a matrix; warns and drops the shear if it
/// has any.
NodeTransform read_gltf_transform(const mesh_io::GltfReader& gltf, int index, std::vector<std::string>& warnings);

/// Returns the quaternion scaled to length one; the identity if it is zero.
Eigen::Quaternionf unit_quaternion(float x, float y, float z, float w);

}  // namespace exemplar::animation_io
