#pragma once

#include <span>

#include "host/hatching/features/orientation_fields.h"

namespace exemplar {

/// Gives the zero elements of an image of orientations (cosine and sine of the double angle, row by row) those of their
/// surroundings: means over squares that grow until they hold some, blended smoothly (pull-push, after Gortler et al.
/// 1996). So directions that are not defined where a picture is flat (thesis App. B.3) go over into those around. Other
/// elements stay; an image of zeros stays as it is. Throws UsageError if sizes do not fit.
void complete_directions(int width, int height, std::span<DoubledAngle> image);

}  // namespace exemplar
