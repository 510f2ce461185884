#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// Options of stroke placement.
struct StrokeOptions {
    std::uint64_t seed = 1;
    /// Minimum distance between strokes of a layer, as a share of the spacing, in (0, 1). Where that is under a
    /// pixel, some strokes may be closer.
    float test_distance = 0.65f;
    /// Minimum length of a stroke, as a share of its target length, in [0, 1]. Three spacings are always enough; two
    /// where other strokes stop only one of its ends, and one where they stop none.
    float min_length = 1.0f / 3;
    float length_jitter = 0.1f;       ///< random variation of lengths, as a share of the target, in [0, 0.5]
    float max_turn = 0.5f;            ///< radians per pixel, in (0, pi / 2]; a sharper turn ends a stroke
    float length_hysteresis = 0.15f;  ///< by which a kept stroke may be too long, share of its target, not negative
    float max_deviation = 0.4f;       ///< radians, in (0, pi / 2], by which a kept stroke may deviate from the field
};

/// Places strokes along the targets of a hatching (thesis Sec. 4.3, after Hertzmann and Zorin 2000; evenly spaced
/// streamlines after Jobard and Lefer 1997). A stroke is traced from a seed to both sides, in steps of one pixel
/// (second-order Runge-Kutta, orientations as doubled angles interpolated between pixels). It ends at its target
/// length, at the border of its layer, at barriers, near another stroke of its layer or itself, and where
/// orientations turn too sharply or cancel out.
///
/// The first strokes grow from the middle of each part of the picture that barriers, levels and orientations
/// delimit. Then strokes are tried one spacing beside those placed, and in line with them behind a small gap;
/// finally in the remaining holes. Many are tried per round. Of those too close to each other one wins, by length,
/// then at random; the others are tried again, so the result could also have come about stroke by stroke. All
/// arithmetic is integer: results are the same, byte for byte, on any number of threads and on any device.
class StrokePlacer {
  public:
    virtual ~StrokePlacer() = default;
    StrokePlacer() = default;
    StrokePlacer(const StrokePlacer&) = delete;
    StrokePlacer& operator=(const StrokePlacer&) = delete;

    /// Returns the strokes of both layers, in placement order. `barriers`: occlusion_barriers(), or empty for none.
    /// `kept`: strokes of the previous frame, moved to their current positions; they come first, clipped to what is
    /// still valid (see clip_strokes()). Spacings are clamped to 1 to 256 pixels, lengths to at most 1024. Throws
    /// UsageError if sizes do not fit, the picture is over 32768 pixels in width or height, targets of hatched
    /// pixels are negative or not finite (or an intensity over 1), a kept stroke is not finite or has no valid
    /// layer, or an option is out of range.
    virtual std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                           const StrokeOptions& options, std::span<const HatchStroke> kept) = 0;
    std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers = {},
                                   const StrokeOptions& options = {}) {
        return place(fields, barriers, options, {});
    }
};

/// Reference implementation.
class CpuStrokePlacer final : public StrokePlacer {
  public:
    using StrokePlacer::place;
    std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                   const StrokeOptions& options, std::span<const HatchStroke> kept) override;
};

}  // namespace exemplar
