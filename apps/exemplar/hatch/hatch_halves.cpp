#include "apps/exemplar/hatch/hatch_halves.h"

#include <array>

#include "apps/exemplar/hatch/hatch_draw.h"
#include "host/core/statistics.h"
#include "host/hatching/drawing/aligned_drawing.h"
#include "host/hatching/fields/ink.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/style/style_learning.h"
#include "host/hatching/view_hatching.h"

namespace exemplar {
namespace {

/// Returns the medians of x and y over the pixels on center lines of strokes.
std::array<int, 2> middle_of(const DrawingProperties& drawing) {
    std::vector<int> x, y;
    for (int row = 0; row < drawing.height; ++row)
        for (int column = 0; column < drawing.width; ++column)
            if (drawing.center[static_cast<std::size_t>(row) * drawing.width + column]) {
                x.push_back(column);
                y.push_back(row);
            }
    return {upper_median(x), upper_median(y)};
}

/// The pixels of a half: along x or y, those below the middle, or the others.
PixelMask half_of(const DrawingProperties& drawing, std::array<int, 2> middle, bool along_y, bool below) {
    PixelMask half(drawing.width, drawing.height, 1);
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            half.pixel(x, y)[0] = ((along_y ? y < middle[1] : x < middle[0]) == below) ? 1 : 0;
    return half;
}

ComparedDrawing hatched(const HatchingStyle& style, HatchScene& scene, const ComparedDrawing& artist) {
    ViewHatching hatching = hatch_view(style, scene.pixels(), scene.tools());
    taper_strokes(hatching.strokes, style.taper);
    const FloatImage& size = artist.darkness;
    FloatImage darkness(size.width, size.height, 1);
    darkness.data = render_ink(hatching.strokes, size.width, size.height);
    StrokeMeasurements strokes = measure_strokes(darkness, object_mask(scene.pixels()));
    return {std::move(darkness), std::move(strokes)};
}

}  // namespace

std::vector<HalfComparison> compare_halves(HatchScene& scene, const ComparedDrawing& artist, const PixelMask& mask,
                                           std::uint64_t seed, const std::function<void(const char*)>& progress) {
    const DrawingProperties whole = drawing_properties(artist.strokes);
    const std::array<int, 2> middle = middle_of(whole);
    std::vector<HalfComparison> out;
    constexpr std::array<const char*, 4> k_halves{"left", "right", "upper", "lower"};
    for (std::size_t h = 0; h < k_halves.size(); ++h) {
        progress(k_halves[h]);
        DrawingProperties known = whole;
        restrict_to(half_of(whole, middle, h >= 2, h % 2 == 0), known);
        StyleReport report;
        const HatchingStyle style =
            learn_hatching_style(scene.pixels(), known, scene.tools().scorer, {.seed = seed}, report);
        PixelMask other = half_of(whole, middle, h >= 2, h % 2 != 0);
        for (std::size_t i = 0; i < other.data.size(); ++i) other.data[i] = other.data[i] && mask.data[i];
        out.push_back({k_halves[h], compare_drawings(artist, hatched(style, scene, artist), other)});
    }
    return out;
}

}  // namespace exemplar
