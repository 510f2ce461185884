#pragma once

#include <cstddef>
#include <string_view>

#include "gpu/runtime/device/device.h"

namespace exemplar {

/// Throws DeviceLimitError if kernels of the device cannot see this many texels at once; `what` needs them.
void check_texels(const Device& device, std::size_t texels, std::string_view what);

}  // namespace exemplar
