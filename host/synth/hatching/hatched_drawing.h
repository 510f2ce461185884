#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "host/hatching/fields/hatch_stroke.h"
#include "host/hatching/placement/streamlines.h"
#include "host/synth/hatching/hatching_rules.h"

namespace exemplar {

/// Inaccuracy of a hand: standard deviations.
struct HandJitter {
    float turn = 0.025f;     ///< rotation of a stroke about its middle, in radians
    float shift = 0.08f;     ///< shift of a stroke across its direction, in spacings
    float width = 0.06f;     ///< relative, of a stroke
    float darkness = 0.04f;  ///< relative, of a stroke
    float wave = 0.25f;      ///< amplitude of a slow wave along a stroke, in pixels
};

/// A drawing that follows a known rule, as if drawn by hand.
struct RuledDrawing {
    HatchingFields truth;
    std::vector<HatchStroke> strokes;
    std::vector<float> ink;  ///< darkness of each pixel, in [0, 1]
};

/// Hatches a view in a style of hatching_rule_names(). The same seed gives the same drawing.
RuledDrawing draw_by_rule(std::string_view style, PixelFeatures& pixels, StrokePlacer& placer, std::uint64_t seed,
                          const HandJitter& jitter = {});

}  // namespace exemplar
