#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host/animation/read_animation.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// The surface in a file or folder, with its motions if it has any.
struct SurfaceFile {
    /// A mesh becomes a sequence without clips; its shape at rest is the result of drawable_mesh().
    Animation animation;
    std::optional<FaceLabels> labels;  ///< in a mesh file, see MeshFile
    /// Why a file that may hold an animation was read as a mesh. Also a warning of `animation` if the file has what
    /// could move.
    std::string why_still;
};

/// Reads a folder as an animation; a glTF file, and one that exemplar-import reads, as an animation or else as a mesh;
/// and any other file as a mesh (see read_animation, read_mesh). Throws DataError if there is nothing at `path`,
/// MeshError if it is neither.
SurfaceFile read_surface(const std::filesystem::path& path, const ReadAnimationOptions& options = {});

}  // namespace exemplar
