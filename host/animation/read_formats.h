#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "host/animation/read_animation.h"

/// The reader of each kind of animation, before check_animation.
namespace exemplar::animation_io {

/// `content` is a whole .gltf or .glb file, `name` its path for messages, `folder` where its buffers are looked for.
Animation read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder,
                    const ReadAnimationOptions& options);

/// A mesh sequence, or blend shapes if one of the meshes is called neutral.
Animation read_folder(const std::filesystem::path& folder, const ReadAnimationOptions& options);

}  // namespace exemplar::animation_io
