#pragma once

#include <memory>

#include "gpu/hatching/hatching_evaluator.h"
#include "gpu/hatching/pixel_projection.h"
#include "gpu/hatching/stroke_placer.h"
#include "gpu/imaging/gbuffer_renderer.h"
#include "gpu/imaging/image_derivatives.h"
#include "gpu/learn/stump_scorer.h"
#include "gpu/runtime/device/device.h"
#include "host/hatching/view_hatching.h"

namespace exemplar {

/// A device and everything that hatches pictures on it. Only one thread at a time may use it.
class HatchingDevice {
  public:
    explicit HatchingDevice(const DeviceOptions& options = {})
        : device_(options),
          gbuffers_(device_),
          filters_(device_),
          projection_(projection_for(device_)),
          scorer_(stump_scorer_for(device_)),
          evaluator_(device_),
          placer_(device_) {}

    const HatchingTools& tools() const { return tools_; }
    Device& device() { return device_; }

  private:
    Device device_;
    GpuGBufferRenderer gbuffers_;
    GpuImageFilters filters_;
    std::unique_ptr<PixelProjection> projection_;
    std::unique_ptr<StumpScorer> scorer_;
    GpuHatchingEvaluator evaluator_;
    GpuStrokePlacer placer_;
    ImageTools images_{gbuffers_, filters_, *projection_};
    HatchingTools tools_{images_, *scorer_, evaluator_, placer_};
};

}  // namespace exemplar
