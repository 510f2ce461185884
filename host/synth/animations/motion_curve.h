#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "host/core/random.h"

namespace exemplar {

/// A random function of time with two continuous derivatives: a uniform cubic B-spline with control values uniform
/// in [low, high], which also bound its values.
class MotionCurve {
  public:
    /// Covers times from 0 to `duration` seconds, one control value every `spacing` seconds.
    MotionCurve(Random random, double low, double high, double spacing, double duration) : spacing_(spacing) {
        const auto count = static_cast<std::size_t>(std::ceil(duration / spacing)) + 4;
        for (std::size_t i = 0; i < count; ++i) controls_.push_back(random.uniform(low, high));
    }

    double at(double time) const {
        const double position = std::max(time / spacing_, 0.0);
        const std::size_t k = std::min(static_cast<std::size_t>(position), controls_.size() - 4);
        const double t = std::min(position - static_cast<double>(k), 1.0), u = 1 - t;
        return (u * u * u * controls_[k] + (3 * t * t * t - 6 * t * t + 4) * controls_[k + 1] +
                (3 * u * u * u - 6 * u * u + 4) * controls_[k + 2] + t * t * t * controls_[k + 3]) /
               6;
    }

  private:
    double spacing_;
    std::vector<double> controls_;
};

}  // namespace exemplar
