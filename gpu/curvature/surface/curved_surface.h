#pragma once

#include "gpu/runtime/record/buffer.h"

namespace exemplar {

/// A surface of one moment on the device. Curvature as GpuCurvature and GpuLearnedCurvature have it; null where there
/// is none, or it has no derivatives.
struct GpuCurvedSurface {
    const Buffer& vertices;  ///< a vec4 (x, y, z, 1) per vertex
    const Buffer& normals;   ///< a vec4 (unit normal, any) per vertex
    const Buffer* first = nullptr;
    const Buffer* second = nullptr;
    const Buffer* derivative = nullptr;
};

}  // namespace exemplar
