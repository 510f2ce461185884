#pragma once

#include <string>
#include <vector>

#include "host/animation/animation.h"

namespace exemplar {

/// Makes the influences of a rig what Rig promises: by rising bone, each at least 1e-4, summing to one. A vertex
/// without weight is bound to the first bone that it lists (with whatever weight), else to the first of all. Appends
/// warnings; throws MeshError that begins with `name` if a weight is not finite or a bone does not exist.
void clean_influences(Rig& rig, const std::string& name, std::vector<std::string>& warnings);

/// Makes an animation safe to work on, or throws MeshError naming it and what is wrong. Cleans the influences, drops
/// faces that name a vertex twice and frames that are not finite, and warns of these, of faces that have no area in
/// most frames (of up to 64 that it looks at) and of clips that never move. Refused are empty surfaces, indices and
/// counts that do not fit, a rest shape or rig that is not finite, and clips without a finite frame.
void check_animation(Animation& animation);

}  // namespace exemplar
