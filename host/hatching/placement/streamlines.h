#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/fields/hatching_fields.h"

namespace exemplar {

/// How strokes are placed.
struct StrokeOptions {
    std::uint64_t seed = 1;
    /// Strokes of a layer end where they come nearer to each other than this share of the spacing, in (0, 1). Where
    /// that is under a pixel some may come nearer.
    float test_distance = 0.65f;
    /// A stroke that has less room than this share of its target length, in [0, 1], is not drawn; three spacings are
    /// always enough, two where other strokes end only one of its ends, and one where none does.
    float least_length = 1.0f / 3;
    float length_jitter = 0.1f;       ///< by what share, in [0, 0.5], a stroke may be longer or shorter than its target
    float sharpest_turn = 0.5f;       ///< radians a pixel, in (0, pi / 2], beyond which a stroke ends
    float length_hysteresis = 0.15f;  ///< share of its target by which a kept stroke may be too long, not negative
    float most_deviation = 0.4f;      ///< radians, in (0, pi / 2], by which a kept stroke may leave the orientation
};

/// Strokes from the targets of a hatching (thesis Sec. 4.3, which takes it from Hertzmann and Zorin 2000; evenly spaced
/// streamlines as by Jobard and Lefer 1997). A stroke follows the orientation of its layer from a seed, to both sides,
/// by steps of one pixel (second-order Runge-Kutta, orientations as cosine and sine of the double angle between
/// pixels). It ends where its layer has no strokes, at barriers, where its length reaches the target there, where
/// it comes too near to another stroke of its layer or back to itself, and where orientations turn too sharply or
/// cancel out.
///
/// In each part of the picture that barriers, levels and orientations do not divide, a first stroke grows from the
/// middle; then strokes are tried one spacing to the side of those that are there, and in line with them behind a
/// small gap; at last wherever a hole is left. Many strokes are tried in a round. Of those that come too near to each
/// other one wins, by length and then by chance; the others are tried again. So the result is one that could have come
/// about stroke by stroke. All of that is done in whole numbers: results are the same, byte for byte, on any number of
/// threads and on any device.
class StrokePlacer {
  public:
    virtual ~StrokePlacer() = default;
    StrokePlacer() = default;
    StrokePlacer(const StrokePlacer&) = delete;
    StrokePlacer& operator=(const StrokePlacer&) = delete;

    /// Strokes of both layers, in the order in which they were placed. `barriers`: occlusion_barriers(), or empty for
    /// none. `kept`: strokes of the picture before, moved to where they belong now; each is cut to the longest part
    /// that is still valid, in their order, and they come first, unless too little is left. Then those that are
    /// shorter than new strokes may be grow at their ends, as new ones would. Spacings under 1 pixel
    /// or over 256 are taken for that, as are lengths over 1024. Throws UsageError if sizes do not fit, the picture is
    /// over 32768 pixels in width or height, targets of hatched pixels are negative or not finite (or an intensity over
    /// 1), a kept stroke is not finite or of no layer, or an option is out of range.
    virtual std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                           const StrokeOptions& options, std::span<const HatchStroke> kept) = 0;
    std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers = {},
                                   const StrokeOptions& options = {}) {
        return place(fields, barriers, options, {});
    }
};

/// The readable reference.
class CpuStrokePlacer final : public StrokePlacer {
  public:
    using StrokePlacer::place;
    std::vector<HatchStroke> place(const HatchingFields& fields, std::span<const std::uint8_t> barriers,
                                   const StrokeOptions& options, std::span<const HatchStroke> kept) override;
};

}  // namespace exemplar
