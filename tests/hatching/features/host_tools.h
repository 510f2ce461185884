#pragma once

#include "host/hatching/features/image_tools.h"
#include "host/hatching/features/pixel_features.h"

namespace exemplar {

/// What pixel features are measured with on the host.
struct HostTools {
    CpuGBufferRenderer gbuffers;
    CpuImageFilters filters;
    CpuPixelProjection projection;
    ImageTools tools{gbuffers, filters, projection};
};

}  // namespace exemplar
