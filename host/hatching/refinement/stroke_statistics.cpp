#include "host/hatching/refinement/stroke_statistics.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/placement/stroke_gaps.h"

namespace exemplar {
namespace {}  // namespace

SpacingMeasure measure_spacing(std::span<const HatchStroke> strokes, const HatchingFields& fields) {
    const StrokeGaps meter(strokes, fields);
    std::vector<std::vector<StrokeGaps::Gaps>> gaps(strokes.size());
    std::vector<float> least(strokes.size());
    parallel_for(
        strokes.size(),
        [&](std::size_t i) {
            gaps[i] = meter.beside(static_cast<std::uint32_t>(i));
            least[i] = meter.least(static_cast<std::uint32_t>(i));
        },
        16);

    SpacingMeasure result{.min_ratio = 1};
    std::vector<double> errors;
    for (std::size_t i = 0; i < gaps.size(); ++i) {
        result.min_ratio = std::min(result.min_ratio, static_cast<double>(least[i]));
        for (const StrokeGaps::Gaps& beside : gaps[i])
            for (const float ratio : beside.ratio) {
                if (ratio == StrokeGaps::k_invalid_index) continue;
                errors.push_back(std::abs(static_cast<double>(ratio) - 1));
                result.mean_ratio += static_cast<double>(ratio);
            }
    }
    result.gaps = errors.size();
    if (result.gaps) result.mean_ratio /= static_cast<double>(result.gaps);
    result.median_error = upper_median(errors);
    return result;
}

int tone_reach(float spacing) {
    return static_cast<int>(std::clamp(std::round(1.5f * spacing), 1.0f, 1e6f));
}

ToneMeasure measure_tone(std::span<const HatchStroke> strokes, const HatchingFields& fields) {
    const std::vector<float> ink = render_ink(strokes, fields.width, fields.height), target = target_tone(fields);
    const WindowMeans inks(ink, fields.width, fields.height), targets(target, fields.width, fields.height);
    std::vector<double> errors;
    for (int y = 0; y < fields.height; ++y)
        for (int x = 0; x < fields.width; ++x) {
            const std::size_t i = fields.index(x, y);
            if (target[i] == 0) continue;
            const int reach = tone_reach(fields.spacing[i]);
            errors.push_back(std::abs(inks.mean(x, y, reach) / targets.mean(x, y, reach) - 1));
        }
    ToneMeasure result{.pixels = errors.size(), .median_error = upper_median(errors), .mean_ratio = 0};
    double drawn = 0, wanted = 0;
    for (std::size_t i = 0; i < ink.size(); ++i) {
        drawn += static_cast<double>(ink[i]);
        wanted += static_cast<double>(target[i]);
    }
    if (wanted > 0) result.mean_ratio = drawn / wanted;
    return result;
}

}  // namespace exemplar
