#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/tracing/ink_mask.h"
#include "host/hatching/tracing/traced_strokes.h"

namespace exemplar {

/// A point of a stroke.
struct PointId {
    std::int32_t stroke = -1;  ///< -1: none
    std::int32_t point = 0;
};

/// Assigns each pixel of an image to the nearest point of all center lines. Keeps the state of the strokes at its
/// construction.
class StrokeMap {
  public:
    StrokeMap(std::span<const TracedStroke> strokes, int width, int height);

    /// Returns the point whose pixel is nearest to a pixel; none if there are no strokes. Of several points in one
    /// pixel it is the first.
    PointId nearest(int x, int y) const { return owner_[nearest_[index(x, y)]]; }
    /// Returns the distance between the pixel and that of the nearest point.
    float distance(int x, int y) const;
    bool empty() const { return empty_; }
    /// Returns the pixel in which a point lies.
    Pixel pixel_of(const TracedPoint& point) const;

  private:
    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
    }
    int width_, height_;
    bool empty_ = true;
    std::vector<PointId> owner_;
    std::vector<std::int32_t> nearest_;
};

/// A place where the center lines of two strokes meet or cross.
struct StrokeCrossing {
    Vec2 center = Vec2::Zero();
    std::array<std::int32_t, 2> strokes{};  ///< indices, the smaller first
    std::array<Vec2, 2> directions{Vec2::UnitX(), Vec2::UnitY()};
    std::array<float, 2> widths{};

    /// Returns half of the longer diagonal of the rhombus that the ink of both strokes covers, pixels; bounded for
    /// small angles.
    float radius() const;
    /// Whether a place is in that rhombus.
    bool covers(const Vec2& place) const;
};

/// Finds all places where two strokes come within two pixels of each other at an angle of at least `min_angle`
/// radians.
std::vector<StrokeCrossing> find_crossings(std::span<const TracedStroke> strokes, int width, int height,
                                           float min_angle);

/// Returns 1 where the ink of two strokes overlaps.
PixelMask crossing_pixels(std::span<const StrokeCrossing> crossings, int width, int height);
/// Marks the points in those pixels as at crossings.
void mark_crossings(const PixelMask& crossing_pixels, std::span<TracedStroke> strokes);

}  // namespace exemplar
