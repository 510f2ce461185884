#include "host/hatching/hatching_drawing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/hatching/fields/ink.h"
#include "host/lines/strokes/stroke_raster.h"
#include "host/mesh/labels.h"

namespace exemplar {
namespace {

std::vector<float> distances_along(const HatchStroke& stroke) {
    std::vector<float> along{0};
    for (std::size_t i = 1; i < stroke.points.size(); ++i)
        along.push_back(along.back() + (stroke.points[i] - stroke.points[i - 1]).norm());
    return along;
}

HatchStroke scaled_stroke(HatchStroke stroke, float scale) {
    for (Vec2& point : stroke.points) point *= scale;
    for (float& width : stroke.widths) width *= scale;
    return stroke;
}

Stroke scaled_stroke(Stroke stroke, float scale) {
    for (StrokePoint& point : stroke.points) {
        point.position *= scale;
        point.width *= scale;
        point.parameter *= scale;
    }
    return stroke;
}

Color hue_color(float hue) {
    Color color{};
    for (std::size_t c = 0; c < 3; ++c) {
        const float phase = hue - static_cast<float>(c) / 3;
        const float value = 0.5f + 0.42f * std::cos(2 * std::numbers::pi_v<float> * phase);
        color[c] = static_cast<std::uint8_t>(std::lround(255 * value));
    }
    return color;
}

void put(Image& image, std::size_t pixel, const Color& color) {
    std::ranges::copy(color, image.data.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

}  // namespace

void taper_strokes(std::span<HatchStroke> strokes, float taper) {
    for (HatchStroke& stroke : strokes) {
        const std::vector<float> along = distances_along(stroke);
        const float reach = std::min(taper, 0.25f * along.back());
        for (std::size_t i = 0; i < along.size(); ++i)
            stroke.widths[i] *= stroke_taper(std::min(along[i], along.back() - along[i]), reach);
    }
}

DrawingStyle curve_look(const HatchingStyle& style) {
    DrawingStyle look = load_style("ink");
    if (style.outline_width <= 0) return look;
    for (LineStyle& line : look.lines) {
        StrokeThickness& pen = line.thickness;
        pen.width = pen.least = pen.most = style.outline_width;
        pen.taper = std::min(pen.taper, style.taper);
    }
    return look;
}

std::vector<Stroke> layer_strokes(std::span<const HatchStroke> strokes, std::size_t layer) {
    std::vector<Stroke> out;
    for (const HatchStroke& stroke : strokes) {
        if (stroke.layer != layer) continue;
        const std::vector<float> along = distances_along(stroke);
        Stroke& converted = out.emplace_back();
        for (std::size_t i = 0; i < along.size(); ++i) {
            const Vec2 way = stroke.points[std::min(i + 1, along.size() - 1)] - stroke.points[i > 0 ? i - 1 : 0];
            StrokePoint& point = converted.points.emplace_back();
            point.position = stroke.points[i];
            point.normal = way.norm() > 0 ? Vec2(-way.y(), way.x()).normalized() : Vec2(0, 1);
            point.width = stroke.widths[i];
            point.opacity = stroke.darkness;
            point.parameter = along[i];
        }
    }
    return out;
}

SvgSummary write_hatching_svg(const std::filesystem::path& path, const HatchedDrawing& drawing,
                              const DrawingStyle& style, const SvgOptions& options) {
    const std::array<std::vector<Stroke>, k_hatch_layers> hatches{layer_strokes(drawing.strokes, 0),
                                                                  layer_strokes(drawing.strokes, 1)};
    std::vector<SvgLayer> layers{{"hatching", {0, 0, 0}, 1, hatches[0]}, {"cross_hatching", {0, 0, 0}, 1, hatches[1]}};
    for (const DrawingLayer& layer : drawing.curves.layers) {
        const LineStyle& line = style.of(layer.type);
        layers.push_back({std::string(name_of(layer.type)), line.color, line.opacity, layer.strokes});
    }
    constexpr Color k_paper{255, 255, 255};
    return write_layers_svg(path, drawing.width, drawing.height, k_paper, layers, options);
}

Image hatching_picture(const HatchedDrawing& drawing, const DrawingStyle& style, float scale) {
    const int width = std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(drawing.width))));
    const int height = std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(drawing.height))));
    std::vector<HatchStroke> strokes;
    for (const HatchStroke& stroke : drawing.strokes) strokes.push_back(scaled_stroke(stroke, scale));
    const std::vector<float> ink = render_ink(strokes, width, height);
    FloatImage picture(width, height, 3);
    for (std::size_t i = 0; i < ink.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) picture.data[3 * i + c] = 1 - ink[i];
    }
    for (const DrawingLayer& layer : drawing.curves.layers) {
        std::vector<Stroke> curves;
        for (const Stroke& stroke : layer.strokes) curves.push_back(scaled_stroke(stroke, scale));
        draw_strokes(curves, style.of(layer.type), {}, picture);
    }
    Image image(width, height, 3);
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = static_cast<std::uint8_t>(std::lround(255 * std::clamp(picture.data[i], 0.0f, 1.0f)));
    return image;
}

std::array<float, 2> property_range(std::span<const float> values, std::span<const std::uint8_t> known) {
    std::vector<float> sorted;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (known[i]) sorted.push_back(values[i]);
    }
    if (sorted.empty()) return {};
    std::ranges::sort(sorted);
    return {sorted[sorted.size() / 100], sorted[sorted.size() - 1 - sorted.size() / 100]};
}

Image property_picture(std::span<const float> values, std::span<const std::uint8_t> known, int width, int height,
                       const std::array<float, 2>& range) {
    constexpr std::array<float, 3> k_light{222, 235, 247}, k_dark{8, 48, 107};
    Image image(width, height, 3, 255);
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!known[i]) continue;
        const float extent = std::max(range[1] - range[0], 1e-6f * std::max(std::abs(range[1]), 1e-20f));
        const float t = std::clamp((values[i] - range[0]) / extent, 0.0f, 1.0f);
        Color color{};
        for (std::size_t c = 0; c < 3; ++c)
            color[c] = static_cast<std::uint8_t>(std::lround(std::lerp(k_light[c], k_dark[c], t)));
        put(image, i, color);
    }
    return image;
}

Image orientation_picture(std::span<const float> angles, std::span<const std::uint8_t> known, int width, int height) {
    Image image(width, height, 3, 255);
    for (std::size_t i = 0; i < angles.size(); ++i) {
        if (known[i]) put(image, i, hue_color(angles[i] / std::numbers::pi_v<float>));
    }
    return image;
}

Image label_picture(std::span<const std::uint8_t> labels, std::uint8_t none, int width, int height) {
    Image image(width, height, 3, 255);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] != none) put(image, i, label_color(labels[i]));
    }
    return image;
}

}  // namespace exemplar
