#pragma once

#include "gpu/lines/chains.h"
#include "gpu/lines/strokes.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/lines/strokes/coherence.h"
#include "shaders/shared/coherence.h"

namespace exemplar {

/// Places the textures of strokes where they were in the previous frame, as follow_traces does, and measures the
/// flicker of lines. All data stays on the device.
class GpuCoherence {
  public:
    /// `strokes` must live as long as this.
    explicit GpuCoherence(const GpuStrokes& strokes);

    /// Must be recorded once after every record of `strokes`, with the same view. Four dispatches. `keeps`: false
    /// starts the texture of each chain at the chain's start; flicker() is that of such pictures then.
    void record(Stream& stream, const Buffer& vertices, const StrokeView& view, bool keeps);

    /// Two floats per chain point: texture direction along the chain (+1 or -1), and texture offset in pixels, i.e.
    /// coordinate minus direction times arc length (LinePoint::parameter), in [0, period).
    const Buffer& phases() const { return phases_; }
    /// Four floats per segment: texture coordinates at its ends, the share of it that is drawn, and zero.
    const Buffer& traces() const { return traces_; }
    /// Returns the flicker of the last drawn frame; waits for it.
    LineFlicker flicker() const;

  private:
    const GpuStrokes& strokes_;
    Kernel trace_kernel_, vote_kernel_, phase_kernel_, trace_writing_kernel_;
    Buffer traces_, previous_traces_, ends_, votes_, matches_, phases_, flicker_;
};

}  // namespace exemplar
