#include "host/hatching/hatching_drawing.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <numbers>

#include "host/hatching/fields/ink.h"
#include "host/imaging/gbuffer.h"
#include "host/lines/strokes/stroke_raster.h"
#include "host/mesh/labels.h"

namespace exemplar {
namespace {

constexpr Color k_black_ink{0, 0, 0};

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

/// Divides strokes by the inks of the faces that they are drawn on, and scales their widths. A stroke that leaves the
/// surface keeps its ink.
std::map<std::uint32_t, std::vector<HatchStroke>> hatching_by_ink(const HatchedDrawing& drawing) {
    const PartInks& inks = drawing.inks.strokes;
    if (inks.empty()) return {{0, drawing.strokes}};
    const auto ink_at = [&](const Vec2& point, std::uint32_t before) {
        const int x = std::clamp(static_cast<int>(point.x()), 0, drawing.width - 1);
        const int y = std::clamp(static_cast<int>(point.y()), 0, drawing.height - 1);
        const std::uint32_t face = drawing.inks.face.at(static_cast<std::size_t>(y * drawing.width + x));
        return face == k_no_face ? before : inks.ink_of_face.at(face);
    };
    std::map<std::uint32_t, std::vector<HatchStroke>> result;
    const auto add = [&](const HatchStroke& stroke, std::size_t first, std::size_t last, std::uint32_t ink) {
        if (inks.inks[ink].width <= 0) return;
        HatchStroke& part = result[ink].emplace_back(HatchStroke{stroke.layer, {}, {}, stroke.darkness});
        for (std::size_t i = first; i <= last; ++i) {
            part.points.push_back(stroke.points[i]);
            part.widths.push_back(inks.inks[ink].width * stroke.widths[i]);
        }
    };
    for (const HatchStroke& stroke : drawing.strokes) {
        std::size_t first = 0;
        std::uint32_t ink = ink_at(stroke.points[0], 0);
        for (std::size_t i = 1; i + 1 < stroke.points.size(); ++i) {
            const std::uint32_t next = ink_at(stroke.points[i], ink);
            if (next == ink) continue;
            add(stroke, first, i, ink);
            first = i;
            ink = next;
        }
        add(stroke, first, stroke.points.size() - 1, ink);
    }
    return result;
}

/// Darkens a picture by the ink of strokes of one color.
void add_ink(std::span<const float> ink, const Color& color, FloatImage& picture) {
    for (std::size_t i = 0; i < ink.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            float& value = picture.data[3 * i + c];
            value = std::lerp(value, static_cast<float>(color[c]) / 255, ink[i]);
        }
}

/// Feature curves of one type and ink.
struct InkedCurves {
    std::string name;
    LineStyle style;
    std::vector<Stroke> strokes;
};

std::vector<InkedCurves> curves_by_ink(const HatchedDrawing& drawing, const DrawingStyle& style) {
    const PartInks& inks = drawing.inks.curves;
    std::vector<InkedCurves> result;
    for (const DrawingLayer& layer : drawing.curves.layers) {
        const std::string name(name_of(layer.type));
        if (inks.empty()) {
            result.push_back({name, style.of(layer.type), layer.strokes});
            continue;
        }
        for (auto& [ink, strokes] : strokes_by_ink(layer.strokes, inks)) {
            result.push_back({name_of_layer(name, inks, ink), style.of(layer.type), std::move(strokes)});
            result.back().style.color = inks.inks[ink].color.value_or(result.back().style.color);
        }
    }
    return result;
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
    const std::map<std::uint32_t, std::vector<HatchStroke>> by_ink = hatching_by_ink(drawing);
    const std::vector<InkedCurves> curves = curves_by_ink(drawing, style);
    std::deque<std::vector<Stroke>> hatches;  // that the layers refer to
    std::vector<SvgLayer> layers;
    for (std::size_t layer = 0; layer < k_hatch_layers; ++layer)
        for (const auto& [ink, strokes] : by_ink) {
            hatches.push_back(layer_strokes(strokes, layer));
            const Color color = ink > 0 ? drawing.inks.strokes.inks[ink].color.value_or(k_black_ink) : k_black_ink;
            layers.push_back({name_of_layer(layer == 0 ? "hatching" : "cross_hatching", drawing.inks.strokes, ink),
                              color, 1, hatches.back()});
        }
    for (const InkedCurves& curve : curves)
        layers.push_back({curve.name, curve.style.color, curve.style.opacity, curve.strokes});
    constexpr Color k_paper{255, 255, 255};
    return write_layers_svg(path, drawing.width, drawing.height, k_paper, layers, options);
}

Image hatching_picture(const HatchedDrawing& drawing, const DrawingStyle& style, float scale) {
    const int width = std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(drawing.width))));
    const int height = std::max(1, static_cast<int>(std::lround(scale * static_cast<float>(drawing.height))));
    FloatImage picture(width, height, 3, 1.0F);
    for (const auto& [ink, own] : hatching_by_ink(drawing)) {
        std::vector<HatchStroke> strokes;
        strokes.reserve(own.size());
        for (const HatchStroke& stroke : own) strokes.push_back(scaled_stroke(stroke, scale));
        const Color color = ink > 0 ? drawing.inks.strokes.inks[ink].color.value_or(k_black_ink) : k_black_ink;
        add_ink(render_ink(strokes, width, height), color, picture);
    }
    for (InkedCurves& curve : curves_by_ink(drawing, style)) {
        for (Stroke& stroke : curve.strokes) stroke = scaled_stroke(std::move(stroke), scale);
        draw_strokes(curve.strokes, curve.style, {}, picture);
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
