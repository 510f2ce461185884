#pragma once

#include "host/hatching/features/pixel_projection.h"
#include "host/imaging/gbuffer.h"
#include "host/imaging/image_derivatives.h"

namespace exemplar {

/// The implementations that compute image features, each on the CPU or on a device.
struct ImageTools {
    GBufferRenderer& gbuffers;
    ImageFilters& filters;
    PixelProjection& projection;
};

}  // namespace exemplar
