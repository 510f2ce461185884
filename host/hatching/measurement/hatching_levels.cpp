#include "host/hatching/measurement/hatching_levels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/core/parallel.h"
#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/tracing/drawing_filters.h"
#include "host/hatching/tracing/thinning.h"

namespace exemplar {
namespace {

/// Strokes are sorted by orientation into overlapping sectors, each twice as wide as the step to the next. So the
/// strokes of one family are together in at least one sector, and sectors two or more steps apart hold different
/// families.
constexpr std::size_t k_sectors = 12;
constexpr std::size_t k_sectors_apart = 2;
constexpr float k_sector_step = std::numbers::pi_v<float> / static_cast<float>(k_sectors);
constexpr float k_along = 0.5f;  ///< minor radius of a point's mask, in spacings, and how far the masks' union shrinks
constexpr float k_intersection_reach = 2;  ///< max distance to an intersection, spacings: hatches cross in each
constexpr float k_min_region_area = 4;     ///< area of the smallest region, in squared spacings
constexpr int k_absorptions = 4;           ///< rounds, for small regions inside of small regions

std::size_t pixel_at(const Vec2& at, const PixelMask& mask) {
    const int x = std::clamp(static_cast<int>(at.x()), 0, mask.width - 1);
    const int y = std::clamp(static_cast<int>(at.y()), 0, mask.height - 1);
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(mask.width) + static_cast<std::size_t>(x);
}

/// Sets the pixels of the ellipse around a point, which reaches a spacing across the stroke.
void add_ellipse(const TracedPoint& point, PixelMask& mask) {
    const float major = point.spacing, minor = k_along * point.spacing;
    const float cosine = std::cos(point.orientation), sine = std::sin(point.orientation);
    const float wide = std::hypot(minor * cosine, major * sine), high = std::hypot(minor * sine, major * cosine);
    const auto first = [](float low) { return std::max(0, static_cast<int>(std::ceil(low - 0.5f))); };
    const int right = std::min(mask.width - 1, static_cast<int>(std::floor(point.center.x() + wide - 0.5f)));
    const int bottom = std::min(mask.height - 1, static_cast<int>(std::floor(point.center.y() + high - 0.5f)));
    for (int y = first(point.center.y() - high); y <= bottom; ++y)
        for (int x = first(point.center.x() - wide); x <= right; ++x) {
            const Vec2 way = center_of({x, y}) - point.center;
            const float along = (cosine * way.x() + sine * way.y()) / minor;
            const float across = (cosine * way.y() - sine * way.x()) / major;
            if (along * along + across * across <= 1) mask.pixel(x, y)[0] = 1;
        }
}

/// Returns what the strokes of one sector hatch: the union of their ellipses, which reaches a spacing beyond the
/// outermost strokes and half a spacing beyond ends, shrunk by half a spacing within `mask` (closed, not dilated as
/// in the thesis). So it ends half a spacing beyond the outermost strokes, at the ends of strokes, and at the border
/// of the mask; gaps narrower than two spacings close.
std::vector<std::uint8_t> hatched_by_sector(std::span<const TracedStroke> strokes, std::size_t sector,
                                            const PixelMask& mask) {
    PixelMask covered(mask.width, mask.height, 1), lines(mask.width, mask.height, 1);
    BasicImage<float> spacing(mask.width, mask.height, 1);
    bool any = false;
    for (const TracedStroke& stroke : strokes)
        for (const TracedPoint& point : stroke.points) {
            if (point.spacing <= 0) continue;
            if (orientation_difference(point.orientation, static_cast<float>(sector) * k_sector_step) > k_sector_step)
                continue;
            add_ellipse(point, covered);
            const std::size_t pixel = pixel_at(point.center, mask);
            lines.data[pixel] = 1;
            spacing.data[pixel] = point.spacing;
            any = true;
        }
    if (!any) return std::vector<std::uint8_t>(covered.data.size(), 0);
    std::vector<std::uint8_t> blank(covered.data.size());
    for (std::size_t i = 0; i < blank.size(); ++i) blank[i] = mask.data[i] && !covered.data[i];
    const std::vector<std::int32_t> nearest_line = nearest_sites(mask.width, mask.height, lines.data);
    const std::vector<std::int32_t> nearest_blank = nearest_sites(mask.width, mask.height, blank);
    for (std::size_t i = 0; i < blank.size(); ++i) {
        if (!covered.data[i] || nearest_blank[i] == k_no_site) continue;
        const float distance = pixel_distance(static_cast<std::int32_t>(i), nearest_blank[i], mask.width);
        covered.data[i] = distance >= k_along * spacing.data[nearest_line[i]];
    }
    return std::move(covered.data);
}

/// Returns the level by the number of families: pixels that two sectors far enough apart hatch are cross-hatched.
std::vector<std::uint8_t> crossed_level(const std::array<std::vector<std::uint8_t>, k_sectors>& sectors,
                                        const PixelMask& mask) {
    std::vector<std::uint8_t> level(mask.data.size(), k_no_hatching);
    parallel_for(
        level.size(),
        [&](std::size_t i) {
            if (!mask.data[i]) return;
            for (std::size_t a = 0; a < k_sectors; ++a) {
                if (!sectors[a][i]) continue;
                level[i] = std::max(level[i], k_single_hatching);
                for (std::size_t b = a + k_sectors_apart; b < k_sectors && b + k_sectors_apart <= a + k_sectors; ++b)
                    if (sectors[b][i]) level[i] = k_cross_hatching;
            }
        },
        4096);
    return level;
}

/// Turns cross-hatching far from intersections into single hatching: strokes of two families that pass beside each
/// other, or meet at an angle, do not cross. The thesis unites discs around intersections; these leave gaps between
/// them at small angles, and reach too far beyond them.
void demote_far(std::span<const Vec2> intersections, float reach, const PixelMask& mask,
                std::vector<std::uint8_t>& level) {
    std::vector<std::uint8_t> crossed(level.size(), 0);
    for (const Vec2& place : intersections) crossed[pixel_at(place, mask)] = 1;
    const std::vector<std::int32_t> nearest = nearest_sites(mask.width, mask.height, crossed);
    for (std::size_t i = 0; i < level.size(); ++i) {
        if (level[i] != k_cross_hatching) continue;
        if (nearest[i] == k_no_site || pixel_distance(static_cast<std::int32_t>(i), nearest[i], mask.width) > reach)
            level[i] = k_single_hatching;
    }
}

/// Connected pixels of one level, and the number of neighbors of each other level.
struct Region {
    std::vector<std::size_t> pixels;
    std::array<std::size_t, 3> beside{};
};

/// Finds the regions of a level image one by one.
class RegionFinder {
  public:
    RegionFinder(const std::vector<std::uint8_t>& level, const PixelMask& mask)
        : level_(level), mask_(mask), seen_(level.size(), 0) {}

    /// Returns the region around a pixel of the mask; empty if it was found before.
    Region take(std::size_t start) {
        Region region;
        if (!mask_.data[start] || seen_[start]) return region;
        region.pixels.push_back(start);
        seen_[start] = 1;
        for (std::size_t k = 0; k < region.pixels.size(); ++k)
            for (const auto& step : k_neighbor_offsets) look(region.pixels[k], step, region);
        return region;
    }

  private:
    void look(std::size_t from, const std::array<int, 2>& step, Region& region) {
        const auto width = static_cast<std::size_t>(mask_.width);
        const int x = static_cast<int>(from % width) + step[0], y = static_cast<int>(from / width) + step[1];
        if (x < 0 || y < 0 || x >= mask_.width || y >= mask_.height) return;
        const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
        if (!mask_.data[i]) return;
        if (level_[i] != level_[from]) {
            ++region.beside[level_[i]];
        } else if (!seen_[i]) {
            seen_[i] = 1;
            region.pixels.push_back(i);
        }
    }

    const std::vector<std::uint8_t>& level_;
    const PixelMask& mask_;
    std::vector<std::uint8_t> seen_;
};

/// Turns cross-hatching with at most `max_single_intersections` intersections into single hatching.
void demote_regions(std::span<const Vec2> intersections, std::size_t max_single_intersections, const PixelMask& mask,
                    std::vector<std::uint8_t>& level) {
    std::vector<std::uint32_t> at(level.size(), 0);
    for (const Vec2& place : intersections) ++at[pixel_at(place, mask)];
    const std::vector<std::uint8_t> before = level;
    RegionFinder finder(before, mask);
    for (std::size_t start = 0; start < level.size(); ++start) {
        if (before[start] != k_cross_hatching) continue;
        const Region region = finder.take(start);
        std::size_t count = 0;
        for (const std::size_t i : region.pixels) count += at[i];
        if (count > max_single_intersections) continue;
        for (const std::size_t i : region.pixels) level[i] = k_single_hatching;
    }
}

/// Gives regions of fewer than `least` pixels the most frequent level of their neighbors: one stroke that is too
/// short is no region. Returns whether there were any; the regions they join may be small, too.
bool absorb_small_regions(std::size_t least, const PixelMask& mask, std::vector<std::uint8_t>& level) {
    const std::vector<std::uint8_t> before = level;
    RegionFinder finder(before, mask);
    bool any = false;
    for (std::size_t start = 0; start < level.size(); ++start) {
        const Region region = finder.take(start);
        const auto most = std::max_element(region.beside.begin(), region.beside.end());
        if (region.pixels.size() >= least || *most == 0) continue;
        for (const std::size_t i : region.pixels) level[i] = static_cast<std::uint8_t>(most - region.beside.begin());
        any = true;
    }
    return any;
}

}  // namespace

std::vector<std::uint8_t> hatching_levels(std::span<const TracedStroke> strokes, std::span<const Vec2> intersections,
                                          const PixelMask& mask, std::size_t max_single_intersections,
                                          float usual_spacing) {
    std::array<std::vector<std::uint8_t>, k_sectors> sectors;
    parallel_for(k_sectors, [&](std::size_t c) { sectors[c] = hatched_by_sector(strokes, c, mask); });
    std::vector<std::uint8_t> level = crossed_level(sectors, mask);
    demote_far(intersections, k_intersection_reach * usual_spacing, mask, level);
    demote_regions(intersections, max_single_intersections, mask, level);
    const auto least = static_cast<std::size_t>(k_min_region_area * usual_spacing * usual_spacing);
    for (int round = 0; round < k_absorptions && absorb_small_regions(least, mask, level);) ++round;
    return level;
}

std::vector<std::uint8_t> level_boundaries(std::span<const std::uint8_t> level, const PixelMask& mask) {
    std::vector<std::uint8_t> boundary(level.size(), 0);
    for (int y = 0; y < mask.height; ++y)
        for (int x = 0; x < mask.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y) * mask.width + x;
            if (!mask.data[i]) continue;
            for (std::size_t k = 0; k < k_neighbor_offsets.size(); k += 2) {
                const int px = x + k_neighbor_offsets[k][0], py = y + k_neighbor_offsets[k][1];
                if (px < 0 || py < 0 || px >= mask.width || py >= mask.height) continue;
                const std::size_t other = static_cast<std::size_t>(py) * mask.width + px;
                if (mask.data[other] && level[other] != level[i]) boundary[i] = 1;
            }
        }
    return boundary;
}

}  // namespace exemplar
