#include "gpu/curvature/surface/texels.h"

#include <fmt/format.h>

#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {

void check_texels(const Device& device, std::size_t texels, std::string_view what) {
    if (const std::uint64_t limit = device.info().max_texels; texels > limit)
        throw DeviceLimitError(fmt::format("{} need {} texels, over the limit of {} of device '{}'; simplify the mesh "
                                           "or choose another device",
                                           what, texels, limit, device.info().name),
                               texels, limit);
}

}  // namespace exemplar
