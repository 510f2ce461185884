#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "host/animation/animation.h"
#include "host/mesh/gltf/gltf_reader.h"
#include "host/mesh/gltf/gltf_surface.h"

namespace exemplar::animation_io {

/// The generator entry of blend-shape files that Exemplar writes. Without it, meshes that hang on several nodes
/// would be taken for a skeleton.
constexpr std::string_view k_blend_shapes_generator = "Blend shapes written by Exemplar";

/// Returns the rig of a surface: its skin, bound to those nodes of the file that a bone depends on. `rig_node` receives
/// the node of the rig for each node of the file; k_invalid_index if the surface does not depend on it.
Rig rig_of_surface(const mesh_io::GltfReader& gltf, const mesh_io::GltfSurface& surface,
                   std::vector<std::uint32_t>& rig_node, std::vector<std::string>& warnings);

/// Returns `skeleton` if vertices follow several joints of one skin, else (or in a file with
/// k_blend_shapes_generator) `blend_shapes` if there are morph targets, else `sequence`: whole meshes move at most.
/// Takes the final rig, because a joint whose vertices were welded to others, or whose weights were rounded away, moves
/// nothing.
AnimationKind gltf_kind(const mesh_io::GltfReader& gltf, const mesh_io::GltfSurface& surface, const Rig& rig);

}  // namespace exemplar::animation_io
