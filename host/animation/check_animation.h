#pragma once

#include <string>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// Returns whether all numbers of a pose, or of the vertices of a frame, are finite.
bool is_finite(const Pose& pose);
bool is_finite(const std::vector<Vec3>& frame);

/// Makes an animation safe to use, or throws MeshError naming it and the problem. Cleans the influences; drops faces
/// that name a vertex twice and frames that are not finite; keeps one of faces that lie on each other, and turns faces
/// outward by the shape at rest (see merge_coincident_faces, orient_faces). Warns of these, of faces without area in
/// most frames (of up to 64 that are checked) and of clips that never move. Rejects empty surfaces, indices and counts
/// that do not fit, a rest shape or rig that is not finite, and clips without a finite frame.
void check_animation(Animation& animation);

}  // namespace exemplar
