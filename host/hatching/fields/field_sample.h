#pragma once

#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Samples `values`, one of the images of `fields`, at a point (pixels): interpolates bilinearly between those of
/// the four pixels around it that are hatched; 0 if none is.
float sample_hatched(const HatchingFields& fields, const std::vector<float>& values, const Vec2& at);

}  // namespace exemplar
