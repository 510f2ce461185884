#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace exemplar {

/// Returns the value below which `share` (0 to 1) of the total weight lies; sorts `value_weight` by value. Zero if
/// it is empty; if all weights are zero, they count as equal.
inline float weighted_percentile(std::vector<std::pair<float, float>>& value_weight, double share) {
    if (value_weight.empty()) return 0.0F;
    std::sort(value_weight.begin(), value_weight.end());
    double total = 0.0;
    for (const auto& [value, weight] : value_weight) total += static_cast<double>(weight);
    const bool equal = !(total > 0.0);
    const double goal = share * (equal ? static_cast<double>(value_weight.size()) : total);
    double sum = 0.0;
    for (const auto& [value, weight] : value_weight) {
        sum += equal ? 1.0 : static_cast<double>(weight);
        if (sum >= goal) return value;
    }
    return value_weight.back().first;
}

/// Percentiles of many weighted values in [0, maximum] without sorting, to within maximum / bins.
class WeightedHistogram {
  public:
    WeightedHistogram(float maximum, std::size_t bins) { reset(maximum, bins); }
    void reset(float maximum, std::size_t bins) {
        weight_.assign(bins, 0.0);
        width_ = maximum / static_cast<float>(bins);
        per_width_ = maximum > 0.0F ? static_cast<float>(bins) / maximum : 0.0F;
    }
    void add(float value, double weight) {
        weight_[std::min(static_cast<std::size_t>(value * per_width_), weight_.size() - 1)] += weight;
    }
    /// Writes the percentile of each of the rising `shares` (0 to 1); linear within a bin. Zeros if nothing was added.
    void percentiles(std::span<const double> shares, std::span<float> out) const {
        double total = 0.0;
        for (const double weight : weight_) total += weight;
        std::size_t bin = 0;
        double below = 0.0;
        for (std::size_t k = 0; k < shares.size(); ++k) {
            const double goal = shares[k] * total;
            while (bin + 1 < weight_.size() && below + weight_[bin] < goal) below += weight_[bin++];
            const double inside = weight_[bin] > 0.0 ? std::clamp((goal - below) / weight_[bin], 0.0, 1.0) : 0.0;
            out[k] = width_ * (static_cast<float>(bin) + static_cast<float>(inside));
        }
    }

  private:
    std::vector<double> weight_;
    float width_ = 0.0F, per_width_ = 0.0F;
};

}  // namespace exemplar
