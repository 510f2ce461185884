#pragma once

#include "gpu/lines/chains.h"
#include "gpu/lines/strokes.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/lines/strokes/coherence.h"
#include "shaders/shared/coherence.h"

namespace exemplar {

/// Lays the textures of strokes where they were in the frame before, as follow_traces does, and measures how lines
/// flicker. All of it stays on the device.
class GpuCoherence {
  public:
    /// `strokes` must live as long as this.
    explicit GpuCoherence(const GpuStrokes& strokes);

    /// To be recorded once after every record of `strokes`, with its view. Four dispatches. `keeps`: false lets the
    /// texture of each chain begin where the chain does; the flicker is that of such pictures, then.
    void record(Stream& stream, const Buffer& vertices, const StrokeView& view, bool keeps);

    /// Two floats per point of the chains: 1 or -1, the way of the texture along the chain, and its coordinate in
    /// pixels less the way so far (LinePoint::parameter), in [0, its period).
    const Buffer& phases() const { return phases_; }
    /// Four floats per segment: the texture's coordinates at its ends, the share of it that is drawn, and zero.
    const Buffer& traces() const { return traces_; }
    /// Of the frame that was drawn last; waits for it.
    LineFlicker flicker() const;

  private:
    const GpuStrokes& strokes_;
    Kernel trace_kernel_, vote_kernel_, phase_kernel_, settle_kernel_;
    Buffer traces_, previous_traces_, ends_, votes_, matches_, phases_, flicker_;
};

}  // namespace exemplar
