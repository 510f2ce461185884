#include "host/hatching/measurement/point_cells.h"

#include <algorithm>
#include <limits>

namespace exemplar {

PointCells::PointCells(std::span<const TracedStroke> strokes, float cell_size) : size_(cell_size) {
    constexpr float k_far = std::numeric_limits<float>::max();
    Vec2 high(-k_far, -k_far);
    low_ = Vec2(k_far, k_far);
    const auto visit = [&](auto&& body) {
        for (std::size_t s = 0; s < strokes.size(); ++s)
            for (std::size_t p = 0; p < strokes[s].points.size(); ++p)
                body(strokes[s].points[p].center, PointId{static_cast<std::int32_t>(s), static_cast<std::int32_t>(p)});
    };
    visit([&](const Vec2& at, PointId) { low_ = low_.cwiseMin(at), high = high.cwiseMax(at); });
    if (!(low_.x() <= high.x())) return;
    columns_ = column(high.x()) + 1, rows_ = row(high.y()) + 1;
    const auto cell_of = [&](const Vec2& at) {
        return static_cast<std::size_t>(row(at.y())) * static_cast<std::size_t>(columns_) + column(at.x());
    };
    start_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    visit([&](const Vec2& at, PointId) { ++start_[cell_of(at) + 1]; });
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
    points_.resize(start_.back());
    std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
    visit([&](const Vec2& at, PointId id) { points_[next[cell_of(at)]++] = id; });
}

std::span<const PointId> PointCells::cell(int column, int row) const {
    if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return {};
    const std::size_t i = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) + column;
    return std::span(points_).subspan(start_[i], start_[i + 1] - start_[i]);
}

}  // namespace exemplar
