#pragma once

#include <vector>

#include "host/animation/gltf_rig.h"
#include "host/animation/read_animation.h"

namespace exemplar::animation_io {

/// The nodes and morph targets of a surface that the channels of a glTF file move.
struct GltfLinks {
    std::vector<std::uint32_t>
        rig_node;  ///< per node of the file; k_invalid_index if the surface does not depend on it
    std::vector<mesh_io::GltfSurface::Targets> targets;  ///< per node of the file: the morph targets of its mesh
};

/// Reads the clips of a glTF file as poses of `animation.rig`, sampled at the rate of `options` from time 0 to the
/// last key (one frame if there is one key). Merges animations that converters made of one take, and leaves out
/// those that move nothing of the rig, both with a warning in `animation`. Throws MeshError if keys do not fit, or
/// if frames would take far more memory than the file.
std::vector<Clip> read_gltf_clips(mesh_io::GltfReader& gltf, const GltfLinks& links,
                                  const ReadAnimationOptions& options, Animation& animation);

}  // namespace exemplar::animation_io
