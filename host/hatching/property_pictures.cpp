#include "host/hatching/property_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/hatching/hatching_fields.h"
#include "host/imaging/raster.h"

namespace exemplar {
namespace {

using Rgb = std::array<std::uint8_t, 3>;

constexpr Rgb k_paper{255, 255, 255}, k_mark{214, 40, 40};
constexpr std::array<Rgb, 3> k_level_colors{{{255, 255, 255}, {158, 200, 232}, {224, 122, 95}}};
constexpr float k_mark_radius = 2;    ///< pixels
constexpr float k_faded = 0.6f;       ///< of the drawing's darkness, under marks
constexpr double k_outermost = 0.01;  ///< share of values at either end that a ramp does not show

/// A color of Oklab (Ottosson 2020), a space even to the eye, by lightness in [0, 1], chroma and hue in radians.
Rgb oklab_color(float lightness, float chroma, float hue) {
    const float a = chroma * std::cos(hue), b = chroma * std::sin(hue);
    const float l = std::pow(lightness + 0.3963377774f * a + 0.2158037573f * b, 3.0f);
    const float m = std::pow(lightness - 0.1055613458f * a - 0.0638541728f * b, 3.0f);
    const float s = std::pow(lightness - 0.0894841775f * a - 1.2914855480f * b, 3.0f);
    const std::array<float, 3> linear{4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
                                      -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
                                      -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s};
    Rgb color{};
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(std::clamp(linear[c], 0.0f, 1.0f))));
    return color;
}

/// From light yellow over green and blue to dark violet.
Rgb ramp_color(float share) {
    return oklab_color(0.9f - 0.6f * share, 0.12f, 1.85f + 3.3f * share);
}

/// An RGB picture of the measured drawing's size by a function of the pixel's index.
template <typename ColorOf>
Image picture_of(const StrokeMeasurements& m, ColorOf color_of) {
    Image image(m.width, m.height, 3);
    for (std::size_t i = 0; i < m.size(); ++i) {
        const Rgb color = color_of(i);
        std::copy(color.begin(), color.end(), image.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return image;
}

PropertyPicture orientation_picture(const StrokeMeasurements& m) {
    const auto color_of = [&](std::size_t i) {
        if (!m.stroke[i]) return k_paper;
        if (m.level[i] == k_no_hatching) return oklab_color(0.8f, 0, 0);
        return oklab_color(m.level[i] == k_single_hatching ? 0.72f : 0.52f, 0.14f, 0.45f + 2 * m.orientation[i]);
    };
    return {"orientation", picture_of(m, color_of), 0, 0, "radians"};
}

/// The range that a ramp shows: of the values of strokes that are not zero.
std::array<float, 2> range_of(const StrokeMeasurements& m, const std::vector<float>& values) {
    std::vector<float> known;
    for (std::size_t i = 0; i < m.size(); ++i)
        if (m.stroke[i] && values[i] > 0) known.push_back(values[i]);
    if (known.empty()) return {0, 0};
    const auto at = [&](double share) {
        const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(known.size() - 1));
        std::nth_element(known.begin(), known.begin() + k, known.end());
        return known[static_cast<std::size_t>(k)];
    };
    return {at(k_outermost), at(1 - k_outermost)};
}

PropertyPicture ramp_picture(const StrokeMeasurements& m, std::string name, const std::vector<float>& values,
                             std::string unit) {
    const auto [low, high] = range_of(m, values);
    const float width = std::max(high - low, 1e-6f);
    const auto color_of = [&, low = low](std::size_t i) {
        if (!m.stroke[i]) return k_paper;
        if (values[i] <= 0) return oklab_color(0.8f, 0, 0);
        return ramp_color(std::clamp((values[i] - low) / width, 0.0f, 1.0f));
    };
    return {std::move(name), picture_of(m, color_of), low, high, std::move(unit)};
}

PropertyPicture stroke_picture(const StrokeMeasurements& m) {
    const auto color_of = [&](std::size_t i) {
        if (!m.stroke[i]) return k_paper;
        Random random(static_cast<std::uint64_t>(m.stroke_id[i]));
        return oklab_color(static_cast<float>(random.uniform(0.4, 0.75)), 0.13f,
                           static_cast<float>(random.uniform(0, 2 * std::numbers::pi)));
    };
    return {"strokes", picture_of(m, color_of), 0, 0, ""};
}

Rgb faded(const FloatImage& darkness, std::size_t i) {
    const float light = 1 - k_faded * std::clamp(darkness.data[i], 0.0f, 1.0f);
    const auto gray = static_cast<std::uint8_t>(std::lround(255 * light));
    return {gray, gray, gray};
}

PropertyPicture intersection_picture(const StrokeMeasurements& m, const FloatImage& darkness) {
    Image image = picture_of(m, [&](std::size_t i) { return faded(darkness, i); });
    for (const Vec2& at : m.intersections)
        for (int y = static_cast<int>(at.y() - k_mark_radius); y <= static_cast<int>(at.y() + k_mark_radius); ++y)
            for (int x = static_cast<int>(at.x() - k_mark_radius); x <= static_cast<int>(at.x() + k_mark_radius); ++x) {
                const Vec2 center(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
                if (x < 0 || y < 0 || x >= m.width || y >= m.height || (center - at).norm() > k_mark_radius) continue;
                std::copy(k_mark.begin(), k_mark.end(), image.pixel(x, y).begin());
            }
    return {"intersections", std::move(image), 0, 0, ""};
}

}  // namespace

std::vector<PropertyPicture> property_pictures(const StrokeMeasurements& m, const FloatImage& darkness) {
    if (darkness.width != m.width || darkness.height != m.height || darkness.channels != 1)
        throw UsageError(fmt::format("a drawing of {} x {} pixels is not the one of {} x {} that was measured",
                                     darkness.width, darkness.height, m.width, m.height));
    std::vector<PropertyPicture> pictures;
    pictures.push_back(orientation_picture(m));
    pictures.push_back(ramp_picture(m, "thickness", m.thickness, "pixels"));
    pictures.push_back(ramp_picture(m, "spacing", m.spacing, "pixels"));
    pictures.push_back(ramp_picture(m, "length", m.length, "pixels"));
    pictures.push_back(ramp_picture(m, "intensity", m.intensity, "darkness, 1 is black"));
    pictures.push_back({"level", picture_of(m, [&](std::size_t i) { return k_level_colors[m.level[i]]; }), 0, 0, ""});
    pictures.push_back(stroke_picture(m));
    pictures.push_back(intersection_picture(m, darkness));
    const auto boundary_color = [&](std::size_t i) { return m.boundary[i] ? k_mark : faded(darkness, i); };
    pictures.push_back({"boundaries", picture_of(m, boundary_color), 0, 0, ""});
    return pictures;
}

}  // namespace exemplar
