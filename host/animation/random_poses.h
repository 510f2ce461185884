#pragma once

#include <cstddef>
#include <cstdint>

#include "host/animation/animation.h"

namespace exemplar {

/// Makes a clip "random" of expressions for a rig with blend shapes but without a clip. In each pose up to four
/// shapes are active, with weights uniform in (0, 1]; nodes are at rest.
Clip random_expressions(const Rig& rig, std::size_t poses, std::uint64_t seed);

}  // namespace exemplar
