#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/io/io_gltf_reader.h"
#include "host/mesh/skin.h"

namespace exemplar::mesh_io {

/// The hierarchy of the nodes of a glTF file.
struct GltfTree {
    std::vector<std::uint32_t> parent;  ///< per node; k_invalid_index at a root
    std::vector<std::uint32_t> order;   ///< all nodes, parents before children; those of the scene first, in its order
    std::vector<bool> in_scene;         ///< per node: whether it is in the default scene
};

/// Reads the hierarchy. Throws MeshError if a node has two parents or is its own ancestor.
GltfTree read_gltf_tree(const GltfReader& gltf);

/// Computes the transform of each node from its space to that of the scene. Throws MeshError if the matrix,
/// translation, rotation or scale of a node has the wrong number of values.
std::vector<Affine3> gltf_world_transforms(const GltfReader& gltf, const GltfTree& tree);

}  // namespace exemplar::mesh_io
