#include "host/hatching/tracing/region_outline.h"

#include <algorithm>
#include <cmath>

#include "host/core/statistics.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/thinning.h"

namespace exemplar {
namespace {

/// Returns the distance from the center of each pixel to that of the nearest one that is set (or not set).
FloatImage distance_to(const PixelMask& region, bool set) {
    std::vector<std::uint8_t> sites(region.data.size());
    for (std::size_t i = 0; i < sites.size(); ++i) sites[i] = (region.data[i] != 0) == set;
    const std::vector<std::int32_t> nearest = nearest_sites(region.width, region.height, sites);
    FloatImage distance(region.width, region.height, 1, static_cast<float>(2 * (region.width + region.height)));
    for (std::size_t i = 0; i < sites.size(); ++i)
        if (nearest[i] != k_no_site)
            distance.data[i] = pixel_distance(static_cast<std::int32_t>(i), nearest[i], region.width);
    return distance;
}

/// Returns the component, connected by eight neighbors (step 1) or four (step 2), of the pixels with the value at
/// `start`; marks them in `seen`.
std::vector<std::size_t> piece_around(const PixelMask& region, std::size_t start, std::size_t step, PixelMask& seen) {
    std::vector<std::size_t> piece{start};
    seen.data[start] = 1;
    const auto width = static_cast<std::size_t>(region.width);
    for (std::size_t k = 0; k < piece.size(); ++k)
        for (std::size_t n = 0; n < k_neighbor_offsets.size(); n += step) {
            const int x = static_cast<int>(piece[k] % width) + k_neighbor_offsets[n][0];
            const int y = static_cast<int>(piece[k] / width) + k_neighbor_offsets[n][1];
            if (x < 0 || y < 0 || x >= region.width || y >= region.height) continue;
            const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            if (seen.data[i] || (region.data[i] != 0) != (region.data[start] != 0)) continue;
            seen.data[i] = 1;
            piece.push_back(i);
        }
    return piece;
}

bool at_image_border(std::size_t pixel, const PixelMask& region) {
    const int x = static_cast<int>(pixel % static_cast<std::size_t>(region.width));
    const int y = static_cast<int>(pixel / static_cast<std::size_t>(region.width));
    return x == 0 || y == 0 || x == region.width - 1 || y == region.height - 1;
}

}  // namespace

PixelMask closed_region(const PixelMask& region, float radius) {
    // With a margin, as the dilated region may exceed the image.
    const int room = static_cast<int>(std::ceil(radius)) + 1;
    PixelMask grown(region.width + 2 * room, region.height + 2 * room, 1);
    for (int y = 0; y < region.height; ++y)
        for (int x = 0; x < region.width; ++x) grown.pixel(x + room, y + room)[0] = region.pixel(x, y)[0];
    const FloatImage outside = distance_to(grown, true);
    for (std::size_t i = 0; i < grown.data.size(); ++i) grown.data[i] = outside.data[i] <= radius;
    const FloatImage inside = distance_to(grown, false);
    PixelMask closed(region.width, region.height, 1);
    for (int y = 0; y < region.height; ++y)
        for (int x = 0; x < region.width; ++x)
            closed.pixel(x, y)[0] = region.pixel(x, y)[0] || inside.pixel(x + room, y + room)[0] > radius;
    return closed;
}

PixelMask without_holes(PixelMask region) {
    PixelMask seen(region.width, region.height, 1);
    for (std::size_t start = 0; start < region.data.size(); ++start) {
        if (region.data[start] || seen.data[start]) continue;
        const std::vector<std::size_t> piece = piece_around(region, start, 2, seen);
        if (std::any_of(piece.begin(), piece.end(), [&](std::size_t i) { return at_image_border(i, region); }))
            continue;
        for (const std::size_t i : piece) region.data[i] = 1;
    }
    return region;
}

PixelMask without_small_pieces(const PixelMask& region, float share) {
    PixelMask seen(region.width, region.height, 1), kept(region.width, region.height, 1);
    std::vector<std::vector<std::size_t>> pieces;
    std::size_t largest = 0;
    for (std::size_t start = 0; start < region.data.size(); ++start) {
        if (!region.data[start] || seen.data[start]) continue;
        pieces.push_back(piece_around(region, start, 1, seen));
        largest = std::max(largest, pieces.back().size());
    }
    for (const std::vector<std::size_t>& piece : pieces)
        if (static_cast<float>(piece.size()) >= share * static_cast<float>(largest))
            for (const std::size_t i : piece) kept.data[i] = 1;
    return kept;
}

FloatImage signed_distance(const PixelMask& region) {
    FloatImage distance = distance_to(region, true);
    const FloatImage inside = distance_to(region, false);
    for (std::size_t i = 0; i < distance.data.size(); ++i)
        distance.data[i] = region.data[i] ? 0.5f - inside.data[i] : distance.data[i] - 0.5f;
    return distance;
}

std::vector<Vec2> border_points(const PixelMask& region, std::size_t most) {
    std::vector<Vec2> all;
    for (int y = 0; y < region.height; ++y)
        for (int x = 0; x < region.width; ++x) {
            if (!region.pixel(x, y)[0]) continue;
            const std::array<bool, 8> n = ring_neighbors(region, x, y);
            if (!(n[0] && n[2] && n[4] && n[6]))
                all.emplace_back(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
        }
    return evenly_spaced(all, most);
}

// Not sample_bilinear(): the search for an alignment spends its time here, and weighted sums take a quarter of the
// time of std::lerp.
float distance_at(const FloatImage& distance, const Vec2& place) {
    const Vec2 at = place - Vec2::Constant(0.5f);
    const float x = std::clamp(at.x(), 0.0f, static_cast<float>(distance.width - 1));
    const float y = std::clamp(at.y(), 0.0f, static_cast<float>(distance.height - 1));
    const int left = static_cast<int>(x), top = static_cast<int>(y);
    const int right = std::min(left + 1, distance.width - 1), bottom = std::min(top + 1, distance.height - 1);
    const float sx = x - static_cast<float>(left), sy = y - static_cast<float>(top);
    const float upper = distance.pixel(left, top)[0] * (1 - sx) + distance.pixel(right, top)[0] * sx;
    const float lower = distance.pixel(left, bottom)[0] * (1 - sx) + distance.pixel(right, bottom)[0] * sx;
    const float inside = upper * (1 - sy) + lower * sy;
    return x == at.x() && y == at.y() ? inside : inside + (at - Vec2(x, y)).norm();
}

Vec2 distance_change(const FloatImage& distance, const Vec2& place, float step) {
    const Vec2 x(step, 0), y(0, step);
    return {distance_at(distance, place + x) - distance_at(distance, place - x),
            distance_at(distance, place + y) - distance_at(distance, place - y)};
}

}  // namespace exemplar
