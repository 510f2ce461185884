// Lets a structure be declared once for C++ and GLSL. In C++ the GLSL names are types of the same size and alignment
// as in std430 blocks; Kernel checks offsets and sizes against the compiled shader.
#ifndef EXEMPLAR_SHARED_TYPES_H
#define EXEMPLAR_SHARED_TYPES_H

#ifdef __cplusplus

#include <cstdint>

#include "gpu/runtime/kernels/layout.h"

namespace exemplar::shared {
using uint = std::uint32_t;
struct alignas(8) vec2 {  // NOLINT(readability-identifier-naming): GLSL's name
    float x, y;
};
struct alignas(16) vec4 {  // NOLINT(readability-identifier-naming): GLSL's name
    float x, y, z, w;
};
struct alignas(16) uvec4 {  // NOLINT(readability-identifier-naming): GLSL's name
    uint x, y, z, w;
};
}  // namespace exemplar::shared

#define SHARED_BEGIN namespace exemplar::shared {
#define SHARED_END }
#else
#define SHARED_BEGIN
#define SHARED_END
#endif

#endif
