#include "host/synth/hatching/hatched_drawing.h"

#include <algorithm>
#include <cmath>

#include "host/core/random.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/fields/occlusion_barriers.h"
#include "host/hatching/refinement/stroke_relaxation.h"

namespace exemplar {
namespace {

/// Returns a normal deviate, clamped to two and a half standard deviations.
float deviate(Random& random, float deviation) {
    return deviation * static_cast<float>(std::clamp(random.normal(), -2.5, 2.5));
}

void jitter_stroke(HatchStroke& stroke, float spacing, const HandJitter& jitter, Random& random) {
    const Vec2 middle = stroke.points[stroke.points.size() / 2];
    const Vec2 way = (stroke.points.back() - stroke.points.front()).normalized(), across(-way.y(), way.x());
    const float turn = deviate(random, jitter.turn), shift = deviate(random, jitter.shift * spacing);
    const float phase = static_cast<float>(random.uniform(0, 6.283)), wave = deviate(random, jitter.wave);
    const Eigen::Matrix2f rotation{{std::cos(turn), -std::sin(turn)}, {std::sin(turn), std::cos(turn)}};
    for (Vec2& point : stroke.points) {
        constexpr float k_wave_length = 25;  // pixels
        const float at = way.dot(point - middle) * (6.283f / k_wave_length) + phase;
        point = middle + rotation * (point - middle) + (shift + wave * std::sin(at)) * across;
    }
    const float width = std::exp(deviate(random, jitter.width));
    for (float& value : stroke.widths) value *= width;
    stroke.darkness = std::min(stroke.darkness * std::exp(deviate(random, jitter.darkness)), 1.0f);
}

}  // namespace

RuledDrawing draw_by_rule(std::string_view style, PixelFeatures& pixels, StrokePlacer& placer, std::uint64_t seed,
                          const HandJitter& jitter) {
    RuledDrawing out{hatching_by_rule(style, pixels), {}, {}};
    const HatchingFields& fields = out.truth;
    out.strokes = place_evenly(placer, fields, occlusion_barriers(pixels.gbuffer().depth, fields.width, fields.height),
                               {.seed = seed});
    Random random(seed);
    for (HatchStroke& stroke : out.strokes) {
        const Vec2& middle = stroke.points[stroke.points.size() / 2];
        const int x = std::clamp(static_cast<int>(middle.x()), 0, fields.width - 1);
        const int y = std::clamp(static_cast<int>(middle.y()), 0, fields.height - 1);
        jitter_stroke(stroke, fields.spacing[fields.index(x, y)], jitter, random);
    }
    out.ink = render_ink(out.strokes, fields.width, fields.height);
    return out;
}

}  // namespace exemplar
