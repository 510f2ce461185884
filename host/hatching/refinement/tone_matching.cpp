#include "host/hatching/refinement/tone_matching.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/hatching/fields/field_sample.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/refinement/stroke_statistics.h"

namespace exemplar {
namespace {

/// The pixel that contains a point, or the nearest one of the picture.
struct TonePixel {
    int x, y;
    TonePixel(const Vec2& at, const HatchingFields& fields)
        : x(static_cast<int>(std::clamp(at.x(), 0.0f, static_cast<float>(fields.width - 1)))),
          y(static_cast<int>(std::clamp(at.y(), 0.0f, static_cast<float>(fields.height - 1)))) {}
};

/// Means of values over `reach` neighbors to both sides, fewer at the ends.
std::vector<float> smoothed(const std::vector<float>& values, std::size_t reach) {
    std::vector<float> result(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t begin = i < reach ? 0 : i - reach, end = std::min(i + reach + 1, values.size());
        for (std::size_t j = begin; j < end; ++j) result[i] += values[j] / static_cast<float>(end - begin);
    }
    return result;
}

class Matcher {
  public:
    Matcher(std::span<const HatchStroke> strokes, const HatchingFields& fields)
        : fields_(fields), target_(target_tone(fields), fields.width, fields.height) {
        thickness_.reserve(strokes.size());
        for (const HatchStroke& stroke : strokes) {
            std::vector<float>& own = thickness_.emplace_back();
            for (const Vec2& at : stroke.points) own.push_back(sample_hatched(fields, fields.thickness, at));
        }
    }

    void iterate(std::span<HatchStroke> strokes) const {
        const WindowMeans tone(render_ink(strokes, fields_.width, fields_.height), fields_.width, fields_.height);
        parallel_for(
            strokes.size(), [&](std::size_t i) { adapt(strokes[i], thickness_[i], tone); }, 16);
    }

  private:
    void adapt(HatchStroke& stroke, const std::vector<float>& thickness, const WindowMeans& tone) const {
        if (stroke.points.empty()) return;
        std::vector<float> factors(stroke.points.size());
        for (std::size_t i = 0; i < factors.size(); ++i) {
            const TonePixel at(stroke.points[i], fields_);
            const int reach = reach_at(at);
            const double is = tone.mean(at.x, at.y, reach), wanted = target_.mean(at.x, at.y, reach);
            const double ratio = is > 0 ? wanted / is : 1;
            factors[i] = static_cast<float>(ratio) * (thickness[i] > 0 ? stroke.widths[i] / thickness[i] : 1);
        }
        // Points are two pixels apart.
        const int reach = reach_at(TonePixel(stroke.points[factors.size() / 2], fields_)) / 2;
        factors = smoothed(factors, static_cast<std::size_t>(reach));
        for (std::size_t i = 0; i < factors.size(); ++i)
            stroke.widths[i] = thickness[i] * std::clamp(factors[i], k_min_width_factor, k_max_width_factor);
    }

    /// Returns three spacings: in smaller windows, strokes would swell at their ends beside every gap.
    int reach_at(const TonePixel& at) const { return 2 * tone_reach(fields_.spacing[fields_.index(at.x, at.y)]); }

    const HatchingFields& fields_;
    WindowMeans target_;
    std::vector<std::vector<float>> thickness_;
};

}  // namespace

void match_tone(std::span<HatchStroke> strokes, const HatchingFields& fields, int iterations) {
    if (iterations < 0) throw UsageError(fmt::format("tones cannot be matched in {} iterations", iterations));
    if (fields.size() == 0) return;
    const Matcher matcher(strokes, fields);
    for (int i = 0; i < iterations; ++i) matcher.iterate(strokes);
}

}  // namespace exemplar
