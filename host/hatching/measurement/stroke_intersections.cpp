#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "host/core/disjoint_sets.h"
#include "host/core/statistics.h"
#include "host/hatching/measurement/hatching_levels.h"
#include "host/hatching/tracing/drawing_filters.h"

namespace exemplar {
namespace {

constexpr float k_corner = 0.03f;            ///< min det / trace^2 of a corner's structure tensor; 1/4 is the limit
constexpr float k_flat = 1e-4f;              ///< min trace: below it the image is flat
constexpr float k_corner_scale = 1;          ///< pixels
constexpr float k_min_corner_window = 1.5f;  ///< pixels

/// det / trace^2 of the structure tensor in a Gaussian window: Harris and Stephens' measure without its scale. Zero
/// along straight edges, 1/4 where edges run in all directions.
FloatImage cornerness(const FloatImage& image, float window) {
    const ImageGradient gradient = gaussian_gradient(image, k_corner_scale);
    FloatImage xx = gradient.x, xy = gradient.x, yy = gradient.y;
    for (std::size_t i = 0; i < xx.data.size(); ++i) {
        xx.data[i] *= gradient.x.data[i];
        xy.data[i] *= gradient.y.data[i];
        yy.data[i] *= gradient.y.data[i];
    }
    xx = gaussian_blur(xx, window), xy = gaussian_blur(xy, window), yy = gaussian_blur(yy, window);
    for (std::size_t i = 0; i < xx.data.size(); ++i) {
        const float trace = xx.data[i] + yy.data[i], det = xx.data[i] * yy.data[i] - xy.data[i] * xy.data[i];
        xx.data[i] = trace > k_flat ? det / (trace * trace) : 0;
    }
    return xx;
}

float largest_near(const FloatImage& image, const Vec2& center, float radius) {
    const auto low = [&](float c) { return std::max(0, static_cast<int>(std::floor(c - radius))); };
    float largest = 0;
    for (int y = low(center.y()); y < std::min(image.height, static_cast<int>(center.y() + radius) + 1); ++y)
        for (int x = low(center.x()); x < std::min(image.width, static_cast<int>(center.x() + radius) + 1); ++x)
            largest = std::max(largest, image.pixel(x, y)[0]);
    return largest;
}

float thickness_at(const StrokeCrossing& crossing, std::span<const TracedStroke> strokes) {
    return std::max(strokes[crossing.strokes[0]].width, strokes[crossing.strokes[1]].width);
}

float median_stroke_width(std::span<const TracedStroke> strokes) {
    std::vector<float> widths;
    for (const TracedStroke& stroke : strokes) widths.push_back(stroke.width);
    return upper_median(widths);
}

/// Returns the centroids of groups of places, linked if they are nearer to each other than the larger of their
/// thicknesses.
std::vector<Vec2> merged(const std::vector<Vec2>& places, const std::vector<float>& thickness) {
    std::vector<std::size_t> by_x(places.size());
    std::iota(by_x.begin(), by_x.end(), 0);
    std::stable_sort(by_x.begin(), by_x.end(),
                     [&](std::size_t a, std::size_t b) { return places[a].x() < places[b].x(); });
    const float widest = thickness.empty() ? 0 : *std::max_element(thickness.begin(), thickness.end());
    DisjointSets sets(places.size());
    for (std::size_t i = 0; i < by_x.size(); ++i)
        for (std::size_t k = i + 1; k < by_x.size() && places[by_x[k]].x() - places[by_x[i]].x() < widest; ++k)
            if ((places[by_x[i]] - places[by_x[k]]).norm() < std::max(thickness[by_x[i]], thickness[by_x[k]]))
                sets.join(static_cast<std::uint32_t>(by_x[i]), static_cast<std::uint32_t>(by_x[k]));
    std::vector<Vec2> sum(places.size(), Vec2::Zero()), centers;
    std::vector<int> count(places.size(), 0);
    for (std::uint32_t i = 0; i < places.size(); ++i) sum[sets.find(i)] += places[i], ++count[sets.find(i)];
    for (std::size_t i = 0; i < places.size(); ++i)
        if (count[i]) centers.emplace_back(sum[i] / static_cast<float>(count[i]));
    return centers;
}

}  // namespace

std::vector<Vec2> confirmed_intersections(std::span<const StrokeCrossing> crossings, const FloatImage& darkness,
                                          const PixelMask& skeleton, std::span<const TracedStroke> strokes) {
    if (crossings.empty()) return {};
    const float window = std::max(k_min_corner_window, median_stroke_width(strokes));
    FloatImage lines(skeleton.width, skeleton.height, 1);
    std::copy(skeleton.data.begin(), skeleton.data.end(), lines.data.begin());
    const FloatImage in_drawing = cornerness(darkness, window);
    const FloatImage in_skeleton = cornerness(lines, window);
    std::vector<Vec2> places;
    std::vector<float> thickness;
    for (const StrokeCrossing& crossing : crossings) {
        const float thick = thickness_at(crossing, strokes);
        if (std::min(largest_near(in_drawing, crossing.center, thick),
                     largest_near(in_skeleton, crossing.center, thick)) < k_corner)
            continue;
        places.push_back(crossing.center);
        thickness.push_back(thick);
    }
    return merged(places, thickness);
}

}  // namespace exemplar
