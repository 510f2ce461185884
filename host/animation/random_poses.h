#pragma once

#include <cstddef>
#include <cstdint>

#include "host/animation/animation.h"

namespace exemplar {

/// Expressions of a rig with blend shapes that has no clip: in each pose up to four shapes are active, with weights
/// uniform in (0, 1]; nodes are at rest. Clip "random".
Clip random_expressions(const Rig& rig, std::size_t poses, std::uint64_t seed);

}  // namespace exemplar
