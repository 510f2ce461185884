#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/mesh/gltf/gltf_reader.h"
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

/// The triangles of the default scene of a glTF file, and what moves them. Meshes, stills and animations alike, are
/// read from it, in its order: nodes depth first, copies of a mesh (EXT_mesh_gpu_instancing), primitives, vertices.
struct GltfSurface {
    struct Targets {
        std::uint32_t begin = 0, count = 0;
    };
    std::vector<Vec3> vertices;  ///< as stored, before morphing and skinning; one per element of POSITION and copy
    std::vector<Face> faces;     ///< counter-clockwise also where the transform of a node mirrors
    std::vector<int> materials;  ///< per face; -1 for none
    /// Per vertex its number in the scalar attribute _LABEL, _GROUP or _PART, as Blender exports attributes of its
    /// meshes; NaN where a primitive has none. Empty if no primitive has one.
    std::vector<float> vertex_values;
    Skin skin;  ///< its bones name nodes of the file
    GltfTree tree;
    std::vector<Affine3> world;                             ///< per node of the file: its transform at rest
    std::vector<Targets> targets;                           ///< per node of the file: the morph targets of its mesh
    std::vector<std::uint32_t> target_node;                 ///< per morph target: the node of the file that drives it
    std::vector<bool> target_is_named;                      ///< per morph target: whether the file names it
    std::vector<std::vector<std::uint32_t>> bones_of_skin;  ///< per skin of the file; empty if no mesh has the skin
    std::vector<std::string> warnings;                      ///< what was left out or repaired
};

/// Reads the surface. Each node with a mesh has morph targets of its own; equal bones of several skins are one. Throws
/// MeshError that begins with `name` if no node of the scene has a mesh, or the file contradicts itself.
GltfSurface read_gltf_surface(GltfReader& gltf, const std::string& name);

/// Returns the vertices as viewers show them at rest: morphed by the weights of nodes (else of meshes), and moved by
/// joints or nodes. As glTF 2.0 (section 3.7.3.3) tells, a skinned mesh ignores the transform of its own node.
std::vector<Vec3> vertices_at_rest(const GltfSurface& surface);

}  // namespace exemplar::mesh_io
