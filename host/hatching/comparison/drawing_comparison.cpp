#include "host/hatching/comparison/drawing_comparison.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "host/core/errors.h"
#include "host/core/statistics.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/region_outline.h"

namespace exemplar {
namespace {

constexpr float k_outline_band = 3.5f;         // pixels
constexpr float k_ink_darkness = 65.0f / 255;  // darkness of ink
constexpr float k_pencil_ink = 30.0f / 255;    // of a drawing without dark strokes
constexpr float k_pencil_darkest = 135.0f / 255;
constexpr float k_gradient_sigma = 1.22f, k_tensor_sigma = 1.8f, k_clear_coherence = 0.6f;
constexpr float k_closing_radius = 6;
constexpr float k_near = 3;
constexpr double k_off = 30, k_doubtful = 15;  // degrees

/// Directions of strokes by a structure tensor.
struct StrokeDirections {
    std::vector<float> angle;      // radians in [0, pi)
    std::vector<float> coherence;  // in [0, 1]
};

/// Returns the darkness inside of the mask, paper elsewhere.
FloatImage inside(const FloatImage& darkness, const PixelMask& mask) {
    FloatImage out = darkness;
    for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] = mask.data[i] ? out.data[i] : 0;
    return out;
}

StrokeDirections stroke_directions(const FloatImage& darkness) {
    const ImageGradient gradient = gaussian_gradient(darkness, k_gradient_sigma);
    FloatImage difference = gradient.x, product = gradient.x, energy = gradient.x;
    for (std::size_t i = 0; i < difference.data.size(); ++i) {
        const float x = gradient.x.data[i], y = gradient.y.data[i];
        difference.data[i] = x * x - y * y;
        product.data[i] = 2 * x * y;
        energy.data[i] = x * x + y * y;
    }
    difference = gaussian_blur(difference, k_tensor_sigma);
    product = gaussian_blur(product, k_tensor_sigma);
    energy = gaussian_blur(energy, k_tensor_sigma);
    StrokeDirections out{std::vector<float>(energy.data.size()), std::vector<float>(energy.data.size())};
    for (std::size_t i = 0; i < out.angle.size(); ++i) {
        // Strokes run across the gradient.
        const float angle = 0.5f * std::atan2(product.data[i], difference.data[i]) + 0.5f * std::numbers::pi_v<float>;
        out.angle[i] = angle < std::numbers::pi_v<float> ? angle : 0;
        out.coherence[i] = std::hypot(difference.data[i], product.data[i]) / std::max(energy.data[i], 1e-10f);
    }
    return out;
}

/// Returns from which darkness on pixels count as ink.
float ink_threshold(const FloatImage& artist, const PixelMask& mask) {
    std::vector<float> values;
    for (std::size_t i = 0; i < mask.data.size(); ++i)
        if (mask.data[i]) values.push_back(artist.data[i]);
    return quantile(values, 0.98) < k_pencil_darkest ? k_pencil_ink : k_ink_darkness;
}

PixelMask darker_than(const FloatImage& darkness, float threshold) {
    PixelMask out(darkness.width, darkness.height, 1);
    for (std::size_t i = 0; i < out.data.size(); ++i) out.data[i] = darkness.data[i] > threshold;
    return out;
}

/// Returns the pixels where both drawings have ink of a clear direction; the drawing's may be a pixel beside it.
PixelMask inked_by_both(const PixelMask& artist_ink, const StrokeDirections& artist, const PixelMask& drawing_ink,
                        const StrokeDirections& drawing) {
    PixelMask both(artist_ink.width, artist_ink.height, 1);
    const auto drawn_near = [&](int x, int y) {
        for (int v = std::max(0, y - 1); v <= std::min(both.height - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(both.width - 1, x + 1); ++u) {
                const std::size_t i = static_cast<std::size_t>(v) * both.width + u;
                if (drawing_ink.data[i] && drawing.coherence[i] > k_clear_coherence) return true;
            }
        return false;
    };
    for (int y = 0; y < both.height; ++y)
        for (int x = 0; x < both.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * both.width + x;
            both.data[i] = artist_ink.data[i] && artist.coherence[i] > k_clear_coherence && drawn_near(x, y);
        }
    return both;
}

/// The directions of both drawings, and the pixels where they are compared.
struct DirectionPair {
    StrokeDirections artist, drawing;
    PixelMask both;

    double degrees(std::size_t i) const {
        return static_cast<double>(orientation_difference(artist.angle[i], drawing.angle[i])) * 180 / std::numbers::pi;
    }
};

DirectionPair directions_of(const FloatImage& artist, const FloatImage& drawing, float ink) {
    DirectionPair pair{stroke_directions(artist), stroke_directions(drawing), {}};
    pair.both = inked_by_both(darker_than(artist, ink), pair.artist, darker_than(drawing, ink), pair.drawing);
    return pair;
}

void compare_directions(const DirectionPair& pair, DrawingComparison& out) {
    std::vector<double> off;
    for (std::size_t i = 0; i < pair.both.data.size(); ++i)
        if (pair.both.data[i]) off.push_back(pair.degrees(i));
    out.inked_by_both = off.size();
    if (off.empty()) return;
    for (const double degrees : off) {
        out.direction_mean += degrees / static_cast<double>(off.size());
        out.direction_off += degrees > k_off ? 1 / static_cast<double>(off.size()) : 0;
    }
    out.direction_median = median(std::span(off));
}

PixelMask hatched_region(const FloatImage& darkness, const PixelMask& mask, float ink) {
    PixelMask region = closed_region(darker_than(darkness, ink), k_closing_radius);
    for (std::size_t i = 0; i < region.data.size(); ++i) region.data[i] = region.data[i] && mask.data[i];
    return region;
}

void compare_regions(const FloatImage& artist, const FloatImage& drawing, const PixelMask& mask, float ink,
                     DrawingComparison& out) {
    const PixelMask a = hatched_region(artist, mask, ink), b = hatched_region(drawing, mask, ink);
    double both = 0, either = 0, all = 0;
    for (std::size_t i = 0; i < mask.data.size(); ++i) {
        all += mask.data[i];
        out.hatched[0] += a.data[i];
        out.hatched[1] += b.data[i];
        both += a.data[i] && b.data[i] ? 1 : 0;
        either += a.data[i] || b.data[i] ? 1 : 0;
    }
    out.region_overlap = either > 0 ? both / either : 1;
    for (double& share : out.hatched) share /= all;
}

/// Returns the darkness blurred within the mask, at its pixels.
std::vector<double> tones(const FloatImage& darkness, const PixelMask& mask, float sigma) {
    FloatImage weight(mask.width, mask.height, 1);
    for (std::size_t i = 0; i < weight.data.size(); ++i) weight.data[i] = mask.data[i] ? 1.0f : 0.0f;
    weight = gaussian_blur(weight, sigma);
    const FloatImage sums = gaussian_blur(darkness, sigma);
    std::vector<double> out;
    for (std::size_t i = 0; i < mask.data.size(); ++i)
        if (mask.data[i]) out.push_back(static_cast<double>(sums.data[i] / std::max(weight.data[i], 0.2f)));
    return out;
}

double mean_of(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

double correlation(std::span<const double> a, std::span<const double> b) {
    const double mean_a = mean_of(a), mean_b = mean_of(b);
    double aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = a[i] - mean_a, y = b[i] - mean_b;
        aa += x * x, bb += y * y, ab += x * y;
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

void compare_tones(const FloatImage& artist, const FloatImage& drawing, const PixelMask& mask, float spacing,
                   DrawingComparison& out) {
    float sigma = spacing;
    for (double& tone : out.tone) {
        const std::vector<double> a = tones(artist, mask, sigma), b = tones(drawing, mask, sigma);
        tone = correlation(a, b);
        if (sigma == spacing) out.ink = {mean_of(a), mean_of(b)};
        sigma *= 2;
    }
}

void compare_levels(const StrokeMeasurements& artist, const StrokeMeasurements& drawing, const PixelMask& mask,
                    DrawingComparison& out) {
    double all = 0;
    for (std::size_t i = 0; i < mask.data.size(); ++i) {
        if (!mask.data[i]) continue;
        out.level[artist.level[i]][drawing.level[i]] += 1;
        all += 1;
    }
    for (std::size_t a = 0; a < out.level.size(); ++a)
        for (std::size_t b = 0; b < out.level.size(); ++b) {
            out.level[a][b] /= all;
            out.level_right += a == b ? out.level[a][b] : 0;
        }
}

void compare_properties(const StrokeMeasurements& artist, const StrokeMeasurements& drawing, const PixelMask& mask,
                        DrawingComparison& out) {
    const DrawingProperties a = drawing_properties(artist), b = drawing_properties(drawing);
    const std::vector<std::int32_t> nearest = nearest_sites(b.width, b.height, b.center);
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        std::vector<double> logs;
        for (std::size_t i = 0; i < mask.data.size(); ++i) {
            if (!mask.data[i] || !a.center[i] || nearest[i] == k_no_site) continue;
            if (pixel_distance(static_cast<std::int32_t>(i), nearest[i], b.width) > k_near) continue;
            const float x = a.property[p][i], y = b.property[p][static_cast<std::size_t>(nearest[i])];
            if (x > 0 && y > 0) logs.push_back(std::log(static_cast<double>(y) / static_cast<double>(x)));
        }
        if (logs.empty()) continue;
        out.ratio[p] = std::exp(median(std::span(logs)));
        for (double& value : logs) value = std::abs(value);
        out.factor[p] = std::exp(median(std::span(logs)));
    }
}

void check_sizes(const ComparedDrawing& drawing, const PixelMask& mask) {
    const auto fits = [&](int width, int height) { return width == mask.width && height == mask.height; };
    if (!fits(drawing.darkness.width, drawing.darkness.height) || !fits(drawing.strokes.width, drawing.strokes.height))
        throw UsageError("drawings are compared in one view, but differ from it in size");
}

}  // namespace

PixelMask compared_pixels(const GBuffer& gbuffer, const ViewOutlines& outlines) {
    PixelMask mask(gbuffer.width, gbuffer.height, 1);
    for (std::size_t i = 0; i < mask.data.size(); ++i)
        mask.data[i] = gbuffer.face[i] != k_no_face && outlines.distance(i) > k_outline_band;
    return mask;
}

DrawingComparison compare_drawings(const ComparedDrawing& artist, const ComparedDrawing& drawing,
                                   const PixelMask& mask) {
    check_sizes(artist, mask);
    check_sizes(drawing, mask);
    if (std::ranges::none_of(mask.data, [](std::uint8_t on) { return on != 0; }))
        throw DataError("no pixel is left to compare: the object shows nothing away from its outlines");
    const FloatImage a = inside(artist.darkness, mask), b = inside(drawing.darkness, mask);
    const float ink = ink_threshold(a, mask);
    DrawingComparison out;
    compare_directions(directions_of(a, b, ink), out);
    compare_regions(a, b, mask, ink, out);
    compare_tones(a, b, mask, std::max(artist.strokes.median_spacing, 1.0f), out);
    compare_levels(artist.strokes, drawing.strokes, mask, out);
    compare_properties(artist.strokes, drawing.strokes, mask, out);
    return out;
}

Image comparison_picture(const ComparedDrawing& artist, const ComparedDrawing& drawing, const PixelMask& mask) {
    const FloatImage a = inside(artist.darkness, mask), b = inside(drawing.darkness, mask);
    const DirectionPair pair = directions_of(a, b, ink_threshold(a, mask));
    Image picture(mask.width, mask.height, 3, 255);
    for (std::size_t i = 0; i < mask.data.size(); ++i) {
        std::array<float, 3> color{1, 1, 1};
        if (pair.both.data[i]) {
            const double off = pair.degrees(i);
            color = off > k_off        ? std::array<float, 3>{0.85f, 0, 0}
                    : off > k_doubtful ? std::array<float, 3>{0.9f, 0.6f, 0}
                                       : std::array<float, 3>{0, 0.55f, 0.1f};
        } else {
            const float dark =
                std::clamp(std::max(0.35f * artist.darkness.data[i], 0.7f * drawing.darkness.data[i]), 0.0f, 1.0f);
            color.fill(1 - dark);
        }
        for (std::size_t c = 0; c < 3; ++c)
            picture.data[3 * i + c] = static_cast<std::uint8_t>(std::lround(255 * color[c]));
    }
    return picture;
}

}  // namespace exemplar
