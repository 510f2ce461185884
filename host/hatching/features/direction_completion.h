#pragma once

#include <span>

#include "host/hatching/features/orientation_fields.h"

namespace exemplar {

/// Fills the zero elements of an image of orientations (cosine and sine of the double angle, row by row) from their
/// surroundings by pull-push (after Gortler et al. 1996): smoothly blended means over squares that grow until they
/// hold orientations. So directions that are undefined where a picture is flat (thesis App. B.3) continue those
/// around. Other elements stay; an image of zeros stays as it is. Throws UsageError if sizes do not fit.
void complete_directions(int width, int height, std::span<DoubledAngle> image);

}  // namespace exemplar
