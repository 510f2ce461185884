#include "host/learn/boosting/boosted_regression.h"

#include <numeric>

#include "host/learn/golden_section.h"

namespace exemplar {
namespace {

constexpr double k_min_r = 0.05;
constexpr int k_r_steps = 24;  // golden sections of log r: r is found to a few hundred-thousandths

}  // namespace

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
    // The objective is convex in log r, as a sum of convex functions.
    const auto [log_r, value] = golden_section_minimum([&](double log_of) { return objective(std::exp(log_of)); },
                                                       std::log(k_min_r), std::log(max_r), k_r_steps);
    return {value, std::exp(log_r)};
}

}  // namespace exemplar
