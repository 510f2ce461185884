#pragma once

#include <array>
#include <span>

#include "gpu/lines/chains.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/lines/part_inks.h"
#include "host/lines/strokes/strokes.h"
#include "shaders/shared/lines.h"

namespace exemplar {

/// The look of the strokes of each family, in the order of families (shared::k_contours and so on).
using StrokeLooks = std::array<shared::StrokeLook, shared::k_line_families>;

/// Returns black, untextured looks that differ only in their thresholds.
StrokeLooks plain_looks(const LineThresholds& thresholds, const StrokeThickness& thickness);

/// The inks of the faces of a surface on the device (PartInks).
class GpuPartInks {
  public:
    /// Throws UsageError if there are inks, but not one per face.
    GpuPartInks(const GpuSurface& surface, const PartInks& inks);

    const Buffer& of_faces() const { return of_faces_; }  ///< an index per face
    const Buffer& inks() const { return inks_; }          ///< a vec4 each: color, red -1 for none; factor of the width

  private:
    Buffer of_faces_, inks_;
};

/// Makes strokes of chains on the device, as make_strokes does: visibility, thickness and opacity. In contrast to
/// it, visibility is tested against a depth image, at samples a pixel apart (at most 32 between two points).
class GpuStrokes {
  public:
    /// `chains` must live as long as this.
    explicit GpuStrokes(const GpuChains& chains);

    /// Records the strokes of the chains last recorded. `depths`: a float per pixel of the picture, row by row from
    /// the top, depth of the nearest surface in [0, 1]. Without `inks` all faces have that of the looks. Two
    /// dispatches. Throws UsageError if it is too small.
    void record(Stream& stream, const GpuCurvedSurface& snapshot, const Buffer& depths, const StrokeView& view,
                const StrokeLooks& looks, const GpuPartInks* inks = nullptr);

    /// Two words per point: the visible samples on the way to the next point, a bit each, and their number.
    const Buffer& visible() const { return visible_; }
    /// Two vec4 per point: position in pixels (two floats), width in pixels and opacity; the normal across the
    /// stroke, the index of its ink, and zero.
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
