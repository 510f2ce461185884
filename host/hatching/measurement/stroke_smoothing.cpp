#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "host/core/parallel.h"
#include "host/hatching/measurement/point_cells.h"
#include "host/hatching/measurement/stroke_properties.h"

namespace exemplar {
namespace {

constexpr float k_smoothing_reach = 2.5f;  ///< standard deviations

/// Weighted sums of properties around a point.
struct Sums {
    double profiled = 0, thickness = 0, intensity = 0;
    double weight = 0, length = 0;
    double spaced = 0, spacing = 0;
    double cosine = 0, sine = 0;  ///< of twice the angle to the own orientation
};

class Smoothing {
  public:
    Smoothing(float sigma, float similar, std::span<const TracedStroke> strokes)
        : sigma_(sigma), similar_(similar), strokes_(strokes), cells_(strokes, sigma) {}

    TracedPoint at(PointId id) const {
        const TracedPoint& point = strokes_[id.stroke].points[id.point];
        const int column = cells_.column(point.center.x()), row = cells_.row(point.center.y());
        const int reach = static_cast<int>(std::ceil(k_smoothing_reach));
        Sums sums;
        for (int r = row - reach; r <= row + reach; ++r)
            for (int c = column - reach; c <= column + reach; ++c)
                for (const PointId other : cells_.cell(c, r)) add(point, other, sums);
        return result(point, sums);
    }

  private:
    void add(const TracedPoint& point, PointId other, Sums& sums) const {
        const TracedPoint& near = strokes_[other.stroke].points[other.point];
        const float squared = (near.center - point.center).squaredNorm() / (sigma_ * sigma_);
        if (near.at_crossing || squared > k_smoothing_reach * k_smoothing_reach) return;
        const double weight = static_cast<double>(near.thickness * std::exp(-0.5f * squared));
        if (near.profiled) {
            sums.profiled += weight;
            sums.thickness += weight * near.thickness;
            sums.intensity += weight * near.intensity;
        }
        sums.weight += weight;
        sums.length += weight * near.length;
        if (near.spacing > 0) sums.spaced += weight, sums.spacing += weight * near.spacing;
        const float turn = std::remainder(near.orientation - point.orientation, std::numbers::pi_v<float>);
        if (std::abs(turn) > similar_) return;
        sums.cosine += weight * std::cos(2 * turn);
        sums.sine += weight * std::sin(2 * turn);
    }

    static TracedPoint result(TracedPoint point, const Sums& sums) {
        if (sums.profiled > 0) {
            point.thickness = static_cast<float>(sums.thickness / sums.profiled);
            point.intensity = static_cast<float>(sums.intensity / sums.profiled);
        }
        if (sums.weight > 0) point.length = static_cast<float>(sums.length / sums.weight);
        if (point.spacing > 0 && sums.spaced > 0) point.spacing = static_cast<float>(sums.spacing / sums.spaced);
        const float angle = point.orientation + 0.5f * static_cast<float>(std::atan2(sums.sine, sums.cosine));
        const float wrapped = angle - std::numbers::pi_v<float> * std::floor(angle / std::numbers::pi_v<float>);
        point.orientation = wrapped < std::numbers::pi_v<float> ? wrapped : 0;
        return point;
    }

    float sigma_, similar_;
    std::span<const TracedStroke> strokes_;
    PointCells cells_;
};

}  // namespace

void smooth_properties(float sigma, float similar, std::span<TracedStroke> strokes) {
    std::vector<std::vector<TracedPoint>> smoothed(strokes.size());
    const Smoothing smoothing(sigma, similar, strokes);
    parallel_for(
        strokes.size(),
        [&](std::size_t s) {
            for (std::size_t p = 0; p < strokes[s].points.size(); ++p)
                smoothed[s].push_back(smoothing.at({static_cast<std::int32_t>(s), static_cast<std::int32_t>(p)}));
        },
        4);
    for (std::size_t s = 0; s < strokes.size(); ++s) strokes[s].points = std::move(smoothed[s]);
}

}  // namespace exemplar
