#include "host/lines/stroke_raster.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/lines/stroke_textures.h"

namespace exemplar {

namespace {

/// What one stroke covers of each pixel, and which pixels.
struct Coverage {
    FloatImage alpha;
    std::vector<std::pair<int, int>> touched;

    void add(int x, int y, float value) {
        float& alpha_here = alpha.pixel(x, y)[0];
        if (!(value > alpha_here)) return;
        if (alpha_here == 0) touched.emplace_back(x, y);
        alpha_here = value;
    }
};

float opacity_at(const StrokePoint& a, const StrokePoint& b, const Vec2& pixel, const Image& texture) {
    const Vec2 way = b.position - a.position, to_pixel = pixel - a.position;
    const float squared = way.squaredNorm();
    const float t = squared > 0 ? std::clamp(to_pixel.dot(way) / squared, 0.0f, 1.0f) : 0;
    const float distance = (to_pixel - t * way).norm(), width = std::lerp(a.width, b.width, t);
    const float covered = std::clamp(0.5f * width + 0.5f - distance, 0.0f, 1.0f);
    if (covered == 0) return 0;
    const float right = std::lerp(a.normal.dot(to_pixel - t * way), b.normal.dot(to_pixel - t * way), t);
    const float across = width > 0 ? std::clamp(std::copysign(distance, right) / (0.5f * width), -1.0f, 1.0f) : 0;
    return covered * std::lerp(a.opacity, b.opacity, t) *
           sample_stroke_texture(texture, std::lerp(a.parameter, b.parameter, t), across);
}

void cover(const StrokePoint& a, const StrokePoint& b, const Image& texture, Coverage& coverage) {
    const float reach = 0.5f * std::max(a.width, b.width) + 1;
    const Vec2 low = a.position.cwiseMin(b.position).array() - reach;
    const Vec2 high = a.position.cwiseMax(b.position).array() + reach;
    const auto inside = [](float value, int size) {
        return static_cast<int>(std::clamp(value, 0.0f, static_cast<float>(size)));
    };
    for (int y = inside(low.y(), coverage.alpha.height); y < inside(high.y() + 1, coverage.alpha.height); ++y)
        for (int x = inside(low.x(), coverage.alpha.width); x < inside(high.x() + 1, coverage.alpha.width); ++x) {
            const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
            coverage.add(x, y, opacity_at(a, b, center, texture));
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
    Coverage coverage{FloatImage(image.width, image.height, 1), {}};
    for (const Stroke& stroke : strokes) {
        for (std::size_t i = 0; i + 1 < stroke.points.size(); ++i)
            if (stroke.points[i].visible) cover(stroke.points[i], stroke.points[i + 1], texture, coverage);
        for (const auto& [x, y] : coverage.touched) {
            float& alpha = coverage.alpha.pixel(x, y)[0];
            blend(color, alpha * style.opacity, image.pixel(x, y));
            alpha = 0;
        }
        coverage.touched.clear();
    }
}

}  // namespace exemplar
