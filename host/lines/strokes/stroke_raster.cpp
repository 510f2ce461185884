#include "host/lines/strokes/stroke_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/lines/strokes/stroke_textures.h"

namespace exemplar {

namespace {

/// How a piece of a stroke covers a pixel.
struct Covered {
    float inside = -1;  ///< pixels from the stroke's border; negative: outside
    float opacity = 0;
};

/// How one stroke covers each pixel, and the list of covered pixels.
struct Coverage {
    BasicImage<Covered> pixels;
    std::vector<std::pair<int, int>> touched;

    void add(int x, int y, const Covered& covered) {
        Covered& here = pixels.pixel(x, y)[0];
        if (!(covered.inside > here.inside)) return;
        if (here.inside == Covered{}.inside) touched.emplace_back(x, y);
        here = covered;
    }
};

Covered covered_by(const StrokePoint& a, const StrokePoint& b, const Vec2& pixel, const Image& texture) {
    const Vec2 way = b.position - a.position, to_pixel = pixel - a.position;
    const float squared = way.squaredNorm();
    const float t = squared > 0 ? std::clamp(to_pixel.dot(way) / squared, 0.0f, 1.0f) : 0;
    const float distance = (to_pixel - t * way).norm(), half = 0.5f * std::lerp(a.width, b.width, t);
    const float share = std::clamp(half + 0.5f - distance, 0.0f, 1.0f);
    if (share == 0) return {};
    const float right = std::lerp(a.normal.dot(to_pixel - t * way), b.normal.dot(to_pixel - t * way), t);
    const float across = half > 0 ? std::clamp(std::copysign(distance, right) / half, -1.0f, 1.0f) : 0;
    return {half - distance, share * std::lerp(a.opacity, b.opacity, t) *
                                 sample_stroke_texture(texture, std::lerp(a.parameter, b.parameter, t), across)};
}

void cover(const StrokePoint& a, const StrokePoint& b, const Image& texture, Coverage& coverage) {
    const float reach = 0.5f * std::max(a.width, b.width) + 1;
    const Vec2 low = a.position.cwiseMin(b.position).array() - reach;
    const Vec2 high = a.position.cwiseMax(b.position).array() + reach;
    const auto inside = [](float value, int size) {
        return static_cast<int>(std::clamp(value, 0.0f, static_cast<float>(size)));
    };
    for (int y = inside(low.y(), coverage.pixels.height); y < inside(high.y() + 1, coverage.pixels.height); ++y)
        for (int x = inside(low.x(), coverage.pixels.width); x < inside(high.x() + 1, coverage.pixels.width); ++x) {
            const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            coverage.add(x, y, covered_by(a, b, center, texture));
        }
}

/// Draws a color of some opacity over a pixel.
void blend(const std::array<float, 3>& color, float alpha, std::span<float> pixel) {
    const float below = pixel.size() == 4 ? pixel[3] * (1 - alpha) : 1 - alpha, total = alpha + below;
    if (!(total > 0)) return;
    for (std::size_t c = 0; c < 3; ++c) pixel[c] = (alpha * color[c] + below * pixel[c]) / total;
    if (pixel.size() == 4) pixel[3] = total;
}

}  // namespace

void draw_strokes(std::span<const Stroke> strokes, const LineStyle& style, const Image& texture, FloatImage& image) {
    if (image.channels != 3 && image.channels != 4)
        throw UsageError(
            fmt::format("strokes cannot be drawn into an image of {} channels; give 3 or 4", image.channels));
    std::array<float, 3> color{};
    for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<float>(style.color[c]) / 255;
    Coverage coverage{BasicImage<Covered>(image.width, image.height, 1), {}};
    for (const Stroke& stroke : strokes) {
        for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
            if (stroke.points[i].visible) cover(stroke.points[i], stroke.points[i + 1], texture, coverage);
        for (const auto& [x, y] : coverage.touched) {
            Covered& covered = coverage.pixels.pixel(x, y)[0];
            blend(color, covered.opacity * style.opacity, image.pixel(x, y));
            covered = {};
        }
        coverage.touched.clear();
    }
}

}  // namespace exemplar
