#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/measurement/stroke_map.h"
#include "host/hatching/tracing/traced_strokes.h"

namespace exemplar {

/// A grid of square cells over the points of strokes, to find those near a place.
class PointCells {
  public:
    PointCells(std::span<const TracedStroke> strokes, float cell_size);

    int column(float x) const { return static_cast<int>((x - low_.x()) / size_); }
    int row(float y) const { return static_cast<int>((y - low_.y()) / size_); }
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    float cell_size() const { return size_; }
    /// Returns the points in a cell, in the order of strokes and points; none if there is no such cell.
    std::span<const PointId> cell(int column, int row) const;

  private:
    float size_;
    Vec2 low_ = Vec2::Zero();
    int columns_ = 0, rows_ = 0;
    std::vector<std::uint32_t> start_;
    std::vector<PointId> points_;
};

}  // namespace exemplar
