#pragma once

#include <filesystem>

#include "host/animation/animation.h"
#include "host/core/errors.h"

namespace exemplar {

/// A mesh file that holds nothing that could move the mesh.
class NoMotionError : public MeshError {
  public:
    using MeshError::MeshError;
};

struct ReadAnimationOptions {
    /// Sampling rate of the clips of glTF files, and rate of the frames of a mesh sequence, in 1/s.
    double frames_per_second = 30;
};

/// Reads a deforming surface:
/// - A glTF 2.0 file (.gltf, .glb) with skins, morph targets or animated nodes. All meshes of its default scene form
/// one
///   surface; vertices that exporters split along seams of textures or normals are welded. Each animation is a clip,
///   sampled from time 0 to its last key; those that converters made of one take are merged. Without a skin of several
///   joints and morph targets the result is a mesh sequence.
/// - FBX or COLLADA (.dae), and 3DS, by the program exemplar-import: the same, translated to glTF.
/// - A folder of meshes of one topology, one per frame in natural order (2 before 10), and optionally
///   `rest.EXTENSION`: a mesh sequence with one clip, named after the folder.
/// - A folder with a mesh `neutral.EXTENSION` (in any case) and others of its topology: blend shapes without clips,
///   with a target per other file, named after it.
/// The result has passed check_animation. Throws MeshError in one line that names the file and says how to fix it,
/// NoMotionError for a file that has neither skins, morph targets nor animations.
Animation read_animation(const std::filesystem::path& path, const ReadAnimationOptions& options = {});

}  // namespace exemplar
