#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/mesh/io/io_gltf_reader.h"

namespace exemplar::animation_io {

/// How the nodes of a glTF file hang together.
struct GltfTree {
    std::vector<std::uint32_t> parent;  ///< per node; k_none at a root
    std::vector<std::uint32_t> order;   ///< all nodes, parents before children
    std::vector<bool> in_scene;         ///< per node: whether it is in the default scene
};

/// Throws MeshError if a node has two parents or is its own ancestor.
GltfTree read_gltf_tree(const mesh_io::GltfReader& gltf);

/// Where node `index` is relative to its parent; a matrix is taken apart, with a warning if that is not possible.
NodeTransform read_gltf_transform(const mesh_io::GltfReader& gltf, int index, std::vector<std::string>& warnings);

/// A quaternion of length one; the identity if all is zero.
Eigen::Quaternionf unit_quaternion(float x, float y, float z, float w);

}  // namespace exemplar::animation_io
