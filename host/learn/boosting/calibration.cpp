#include "host/learn/boosting/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "host/core/parallel.h"
#include "host/learn/golden_section.h"
#include "host/learn/softmax.h"

namespace exemplar {
namespace {

constexpr float k_label_noise = 0.01F;
constexpr double k_min_scale = 0.02, k_max_scale = 10;
constexpr int k_scale_steps = 16;  // golden sections of the scale's logarithm: to about a thousandth of its range
constexpr std::size_t k_calibration_block = 4096;

struct Scored {
    std::span<const float> scores;
    std::span<const std::int32_t> labels;
    std::span<const float> weights;
    std::size_t classes;
};

/// Sums two measures over all rows, block by block in a fixed order, so that the result does not depend on threads.
template <typename Measure>
std::pair<double, double> sum_rows(std::size_t rows, const Measure& measure) {
    std::vector<std::pair<double, double>> of_block((rows + k_calibration_block - 1) / k_calibration_block);
    parallel_for(of_block.size(), [&](std::size_t b) {
        for (std::size_t i = b * k_calibration_block; i < std::min(rows, (b + 1) * k_calibration_block); ++i)
            measure(i, of_block[b]);
    });
    std::pair<double, double> sum{0, 0};
    for (const auto& [first, second] : of_block) sum.first += first, sum.second += second;
    return sum;
}

float probability_of(std::span<const float> row, std::size_t label, Link link, float scale) {
    if (link == Link::softmax) return softmax_at(row, label, scale);
    float sum = 0;
    for (const float h : row) sum += logistic(scale * h);
    return sum > 0 ? logistic(scale * row[label]) / sum : 0;  // all may underflow
}

double total_loss(const Scored& set, Link link, float scale) {
    const float floor = k_label_noise / static_cast<float>(set.classes);
    return sum_rows(set.labels.size(),
                    [&](std::size_t i, std::pair<double, double>& sum) {
                        if (set.weights[i] <= 0) return;
                        const auto row = set.scores.subspan(i * set.classes, set.classes);
                        const float p = probability_of(row, static_cast<std::size_t>(set.labels[i]), link, scale);
                        sum.first -= static_cast<double>(set.weights[i] * std::log((1 - k_label_noise) * p + floor));
                    })
        .first;
}

/// Searches over the logarithm of the scale; returns the scale and its loss.
std::pair<float, double> best_scale(const Scored& set, Link link) {
    const auto loss_at = [&](double log_scale) {
        return total_loss(set, link, static_cast<float>(std::exp(log_scale)));
    };
    const auto [log_scale, loss] =
        golden_section_minimum(loss_at, std::log(k_min_scale), std::log(k_max_scale), k_scale_steps);
    return {static_cast<float>(std::exp(log_scale)), loss};
}

}  // namespace

Calibration calibrate(std::span<const float> scores, std::span<const std::int32_t> labels,
                      std::span<const float> weights, std::size_t classes, std::span<const Link> links) {
    const Scored set{scores, labels, weights, classes};
    const auto [total, wrong] = sum_rows(labels.size(), [&](std::size_t i, std::pair<double, double>& sum) {
        const auto row = scores.subspan(i * classes, classes);
        const auto best = std::max_element(row.begin(), row.end()) - row.begin();
        sum.first += static_cast<double>(weights[i]);
        if (best != labels[i]) sum.second += static_cast<double>(weights[i]);
    });
    Calibration calibration;
    if (total <= 0) {
        calibration.loss = calibration.error = std::numeric_limits<double>::quiet_NaN();
        return calibration;
    }
    calibration.error = wrong / total;
    calibration.loss = std::numeric_limits<double>::infinity();
    for (const Link link : links)
        if (const auto [scale, loss] = best_scale(set, link); loss / total < calibration.loss)
            calibration.link = link, calibration.scale = scale, calibration.loss = loss / total;
    return calibration;
}

}  // namespace exemplar
