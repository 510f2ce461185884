#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host/hatching/registration/region_fit.h"
#include "host/hatching/tracing/traced_strokes.h"

namespace exemplar {

/// A point of a line of the drawing.
struct LinePoint {
    Vec2 place;             ///< pixels
    float orientation = 0;  ///< along the line, radians in [0, pi)
};

/// The lines of a drawing, to be found by place and direction.
class LineMap {
  public:
    LineMap(int width, int height, std::vector<LinePoint> points);

    const std::vector<LinePoint>& points() const { return points_; }
    /// Returns the point nearest to `place` of the lines that run within about 25 degrees of `orientation`; none if
    /// there are none, or if `place` is not in the picture.
    const LinePoint* nearest(const Vec2& place, float orientation) const;

  private:
    static constexpr std::size_t k_bins = 8;
    int width_, height_;
    std::vector<LinePoint> points_;
    std::vector<std::int32_t> point_of_;  ///< per pixel: index of its point
    std::array<std::vector<std::int32_t>, k_bins>
        nearest_;  ///< per direction and pixel: the nearest pixel with a point
};

/// The lines of a drawing that an object's outlines may lie on.
struct DrawnLines {
    LineMap all;
    LineMap outer;          ///< those along the border of what is drawn
    bool outlined = false;  ///< whether the border is drawn; else `outer` is the border of what is hatched
};
DrawnLines drawn_lines(const FloatImage& darkness, const PictureRegion& region);

}  // namespace exemplar
