#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "host/animation/animation.h"
#include "host/mesh/io/io_gltf_reader.h"

namespace exemplar::animation_io {

/// The generator entry of blend-shape files that Exemplar writes. Without it, meshes that hang on several nodes
/// would be taken for a skeleton.
constexpr std::string_view k_blend_shapes_generator = "Blend shapes written by Exemplar";

/// Maps the nodes of a glTF file to the entries of a pose that they drive.
struct GltfLinks {
    struct Targets {
        std::uint32_t begin = 0, count = 0;
    };
    std::vector<std::uint32_t>
        rig_node;                  ///< per node of the file; k_invalid_index if the surface does not depend on it
    std::vector<Targets> targets;  ///< per node of the file: the morph targets of its mesh
    std::vector<std::uint32_t> target_node;  ///< per morph target of the rig: the node of the file that drives it
    std::vector<bool> target_is_named;       ///< per morph target of the rig: whether the file names it
    std::vector<std::vector<std::uint32_t>> bones_of_skin;  ///< per skin of the file; empty if no mesh has the skin
};

/// Reads the surface of the default scene, one vertex per vertex of the file, and its rig into `rest`, `rig` and
/// `warnings` of `animation`. Leaves out nodes that no bone depends on; each node with a mesh has morph targets of
/// its own. Throws MeshError if the file contradicts itself.
GltfLinks read_gltf_rig(mesh_io::GltfReader& gltf, Animation& animation);

/// Returns `skeleton` if vertices follow several joints of one skin, else (or in a file with
/// k_blend_shapes_generator) `blend_shapes`. Takes the final rig, because a joint whose vertices were welded to
/// others, or whose weights were rounded away, moves nothing. Throws MeshError if there is no morph target either.
AnimationKind gltf_kind(const mesh_io::GltfReader& gltf, const GltfLinks& links, const Rig& rig);

}  // namespace exemplar::animation_io
