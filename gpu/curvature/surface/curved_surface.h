#pragma once

#include "gpu/runtime/record/buffer.h"

namespace exemplar {

/// Non-owning buffers of a surface in one frame. Curvature is in the layout of GpuCurvature; null if there is none,
/// or no derivatives.
struct GpuCurvedSurface {
    const Buffer& vertices;  ///< a vec4 (x, y, z, 1) per vertex
    const Buffer& normals;   ///< a vec4 (unit normal, any) per vertex
    const Buffer* first = nullptr;
    const Buffer* second = nullptr;
    const Buffer* derivative = nullptr;
};

}  // namespace exemplar
