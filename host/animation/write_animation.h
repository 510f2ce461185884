#pragma once

#include <filesystem>

#include "host/animation/animation.h"

namespace exemplar {

/// Writes a rig with its morph targets and clips as binary glTF 2.0 (.glb), which read_animation reads: one mesh
/// bound to one skin whose joints are the bones, with linear keys at each frame of each clip. Bones that share a
/// node get child nodes of their own. Names should be UTF-8. Throws UsageError for a mesh sequence, MeshError if the
/// animation is empty, not finite or too large for glTF, DataError if the file cannot be written.
void write_gltf_animation(const std::filesystem::path& path, const Animation& animation);

/// Writes the vertex positions of every frame as binary PLY: `0000.ply`, `0001.ply`, ... with as many digits as the
/// last one needs, and the rest shape (of a rig, its rest pose) as `rest.ply`. Each of several clips gets a folder
/// in `folder`, named after it. read_animation reads such a folder. Throws UsageError if there are no frames,
/// DataError if a file cannot be written or the folder already holds meshes, which would be taken for frames.
void write_sequence(const std::filesystem::path& folder, const Animation& animation);

}  // namespace exemplar
