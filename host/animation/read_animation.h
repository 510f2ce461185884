#pragma once

#include <filesystem>

#include "host/animation/animation.h"

namespace exemplar {

struct ReadAnimationOptions {
    /// Rate at which the clips of glTF files are sampled, and that of the frames of a mesh sequence, in 1/s.
    double frames_per_second = 30;
};

/// Reads a deforming surface:
/// - a glTF 2.0 file (.gltf, .glb) with skins or morph targets. All meshes of its default scene make one surface;
///   vertices that exporters split along seams of textures or normals are welded. Each animation is a clip, sampled
///   from time 0 to its last key; those that converters made of one take are merged.
/// - a folder of meshes of one topology, one a frame in natural order (2 before 10), and maybe `rest.EXTENSION`:
///   a mesh sequence of one clip, named after the folder.
/// - a folder with a mesh `neutral.EXTENSION` (in any case) and others of its topology: blend shapes, a target per
///   other file, named after it, without clips.
/// The result is that of check_animation. Throws MeshError in one line that names the file and the mend.
Animation read_animation(const std::filesystem::path& path, const ReadAnimationOptions& options = {});

}  // namespace exemplar
