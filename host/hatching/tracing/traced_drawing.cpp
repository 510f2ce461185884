#include "host/hatching/tracing/traced_drawing.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/skeleton_graph.h"
#include "host/hatching/tracing/thinning.h"

namespace exemplar {
namespace {

constexpr float k_ink_smoothing = 0.5f;  ///< standard deviation of the blur before ink is found, pixels

FloatImage widths_of(const PixelMask& ink) {
    FloatImage width(ink.width, ink.height, 1, static_cast<float>(2 * std::max(ink.width, ink.height)));
    std::vector<std::uint8_t> blank(ink.data.size());
    for (std::size_t i = 0; i < blank.size(); ++i) blank[i] = !ink.data[i];
    const std::vector<std::int32_t> nearest = nearest_sites(ink.width, ink.height, blank);
    for (std::size_t i = 0; i < blank.size(); ++i)
        if (nearest[i] != k_no_site)
            width.data[i] = std::max(1.0f, 2 * pixel_distance(static_cast<std::int32_t>(i), nearest[i], ink.width) - 1);
    return width;
}

}  // namespace

TracedDrawing trace_drawing(const FloatImage& darkness, const PixelMask& mask, float min_darkness) {
    TracedDrawing drawing;
    const FloatImage smooth = gaussian_blur(darkness, k_ink_smoothing);
    drawing.ink = ink_pixels(smooth, min_darkness);
    drawing.width = widths_of(drawing.ink);
    drawing.skeleton = drawing.ink;
    for (std::size_t i = 0; i < mask.data.size(); ++i)
        drawing.skeleton.data[i] = drawing.skeleton.data[i] && mask.data[i];
    drawing.skeleton = thinned(std::move(drawing.skeleton));
    prune_spurs(drawing.skeleton, drawing.width);
    drawing.strokes = trace_strokes(drawing.skeleton, drawing.width, smooth, min_darkness);
    return drawing;
}

}  // namespace exemplar
