#pragma once

#include <cstddef>
#include <string_view>

#include "gpu/runtime/device/device.h"

namespace exemplar {

/// Throws DeviceLimitError if a texel buffer of the device cannot hold the texels of `what`.
void check_texels(const Device& device, std::size_t texels, std::string_view what);

}  // namespace exemplar
