#include "host/learn/boosting/boosted_regression.h"

#include <numeric>

namespace exemplar {

void RegressionBoosting::normalize() {
    const double total = std::accumulate(weights_.begin(), weights_.end(), 0.0);
    if (!(total > 0)) return;
    for (double& w : weights_) w /= total;
}

RegressionBoosting::Step RegressionBoosting::best_step(std::span<const double> histogram, double bins_per_unit,
                                                       double max_r) const {
    const auto objective = [&](double r) {
        double sum = 0;
        for (std::size_t b = 0; b < histogram.size(); ++b) {
            if (histogram[b] > 0) sum += histogram[b] * std::exp(r * (static_cast<double>(b) + 0.5) / bins_per_unit);
        }
        return sum / std::sqrt(r);
    };
    if (is_first_round_) return {objective(1), 1};
    // The objective is convex in log r, as a sum of convex functions, so golden-section search finds the minimum.
    constexpr double k_golden = 0.6180339887498949, k_min_r = 0.05;
    double low = std::log(k_min_r), high = std::log(max_r);
    for (int step = 0; step < 24; ++step) {
        const double a = high - k_golden * (high - low), b = low + k_golden * (high - low);
        const bool left = objective(std::exp(a)) < objective(std::exp(b));
        (left ? high : low) = left ? b : a;
    }
    const double r = std::exp(0.5 * (low + high));
    return {objective(r), r};
}

}  // namespace exemplar
