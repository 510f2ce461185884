#pragma once

#include <array>
#include <span>

#include "gpu/lines/chains.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/lines/strokes/strokes.h"
#include "shaders/shared/lines.h"

namespace exemplar {

/// How the strokes of each family are drawn, in the order of families (shared::k_contours and so on).
using StrokeLooks = std::array<shared::StrokeLook, shared::k_line_families>;

/// Looks that differ in nothing but what the thresholds say: black, without texture.
StrokeLooks plain_looks(const LineThresholds& thresholds, const StrokeThickness& thickness);

/// From chains to strokes on the device: what of them is hidden in a picture of depths, how thick they are, and how
/// opaque, as make_strokes has it. What differs: visibility is that of samples a pixel apart (32 at most between two
/// points).
class GpuStrokes {
  public:
    /// `chains` must live as long as this.
    explicit GpuStrokes(const GpuChains& chains);

    /// Strokes of the chains last recorded. `depths` has a float per pixel of the picture, row by row from the top: the
    /// depth of the nearest surface, in [0, 1]. Two dispatches.
    void record(Stream& stream, const GpuCurvedSurface& moment, const Buffer& depths, const StrokeView& view,
                const StrokeLooks& looks);

    /// Of each point the samples on the way to the next that are visible, a bit each, and their number.
    const Buffer& visible() const { return visible_; }
    /// Of each point two vec4: its place in pixels (two floats), its width in pixels and its opacity; the normal across
    /// the stroke, and two zeros.
    const Buffer& strokes() const { return strokes_; }
    /// StrokeLooks of the last call.
    const Buffer& looks() const { return looks_; }
    const GpuChains& chains() const { return chains_; }

  private:
    const GpuChains& chains_;
    Kernel visibility_kernel_, stroke_kernel_;
    Buffer visible_, strokes_, looks_;
};

}  // namespace exemplar
