#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "host/animation/read_animation.h"

/// The reader of each kind of animation; check_animation is still to be called.
namespace exemplar::animation_io {

/// Reads a whole .gltf or .glb file. `name` is its path for messages, `folder` where its buffers are looked for.
Animation read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder,
                    const ReadAnimationOptions& options);

/// Reads what exemplar-import wrote of the file `name`: the scene as binary glTF, or nothing if nothing could move.
/// Throws NoMotionError for a file without motion, MeshError for output that is damaged.
Animation animation_of_import(std::string_view output, const std::string& name, const ReadAnimationOptions& options);

/// Reads a mesh sequence, or blend shapes if one of the meshes is called neutral.
Animation read_folder(const std::filesystem::path& folder, const ReadAnimationOptions& options);

}  // namespace exemplar::animation_io
