#pragma once

#include <cstddef>

#include "gpu/runtime/device/device.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// Returns the invocations of a kernel that adds up rows (shaders/lib/row_lanes.glsl).
inline std::size_t row_threads(const Device& device, std::size_t rows) {
    return device.runs_card_kernels() ? rows * shared::k_row_group : rows;
}

}  // namespace exemplar
