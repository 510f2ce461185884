#include "host/labeling/inference/linear_expert.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/labeling/inference/cascade_prediction.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/boosting/calibration.h"

namespace exemplar {
namespace {

constexpr std::array<double, 4> k_ridges{1e-4, 1e-3, 1e-2, 1e-1};
constexpr std::array<float, 6> k_ratios{0.5F, 1, 2, 4, 8, 16};
constexpr std::array<Link, 1> k_pooled_links{Link::softmax};

float log_of(float probability) {
    return std::log(std::max(probability, k_min_combined_probability));
}

/// Clamps L to its targets 0 and 1. Values beyond say no more; on a mesh unlike those of training, whose features
/// correlate differently, they may be far beyond.
void hold_to_targets(std::span<float> linear) {
    for (float& value : linear) value = std::clamp(value, 0.0F, 1.0F);
}

/// The held-out rows of all folds, fold by fold, with their labels, weights and log probabilities.
struct HeldOutRows {
    std::vector<std::vector<std::uint32_t>> of_fold;
    std::vector<std::int32_t> label;
    std::vector<float> weight, log_stumps;
};

HeldOutRows hold_out(const LinearRows& data, std::span<const float> stumps, std::span<const float> loss_weight) {
    HeldOutRows held{std::vector<std::vector<std::uint32_t>>(data.fold_count), {}, {}, {}};
    for (const std::uint32_t row : data.rows) held.of_fold[data.fold[row]].push_back(row);
    for (const std::vector<std::uint32_t>& rows : held.of_fold)
        for (const std::uint32_t row : rows) {
            held.label.push_back(data.label[row]);
            held.weight.push_back(loss_weight[row]);
            for (const float p : stumps.subspan(row * data.classes, data.classes)) held.log_stumps.push_back(log_of(p));
        }
    return held;
}

/// Returns whether rows of two labels have a weight. With one label, the most confident classifier would always win.
bool tells_labels_apart(const HeldOutRows& held) {
    std::int32_t first = -1;
    for (std::size_t i = 0; i < held.label.size(); ++i) {
        if (!(held.weight[i] > 0)) continue;
        if (first >= 0 && held.label[i] != first) return true;
        first = held.label[i];
    }
    return false;
}

/// Returns L of all held-out rows, each from the classifier trained without its fold.
std::vector<float> held_out_scores(const LinearRows& data, const HeldOutRows& held,
                                   std::span<const LinearClassifier> without_fold) {
    std::vector<float> scores(held.log_stumps.size());
    std::size_t first = 0;
    for (std::size_t fold = 0; fold < held.of_fold.size(); ++fold) {
        const std::size_t size = held.of_fold[fold].size() * data.classes;
        linear_scores(without_fold[fold], data.features, held.of_fold[fold], std::span(scores).subspan(first, size));
        first += size;
    }
    hold_to_targets(scores);
    return scores;
}

std::vector<LinearClassifier> solve_without_folds(const LinearTraining& training, double ridge, std::size_t folds) {
    std::vector<LinearClassifier> classifiers(folds);
    parallel_for(folds, [&](std::size_t fold) { classifiers[fold] = training.solve(ridge, fold); });
    return classifiers;
}

/// The best combination found; ratio 0: stumps alone.
struct Choice {
    double ridge = 0;
    float ratio = 0;
    Calibration calibration;
    std::vector<LinearClassifier> without_fold;
};

Choice choose(const LinearRows& data, const HeldOutRows& held, const LinearTraining& training,
              const Calibration& stumps_alone) {
    Choice best{0, 0, stumps_alone, {}};
    std::vector<float> pooled(held.log_stumps.size());
    for (const double ridge : k_ridges) {
        check_interrupt();
        const std::vector<LinearClassifier> classifiers = solve_without_folds(training, ridge, data.fold_count);
        const std::vector<float> linear = held_out_scores(data, held, classifiers);
        for (const float ratio : k_ratios) {
            for (std::size_t i = 0; i < pooled.size(); ++i) pooled[i] = held.log_stumps[i] + ratio * linear[i];
            const Calibration now = calibrate(pooled, held.label, held.weight, data.classes, k_pooled_links);
            if (now.loss < best.calibration.loss) best = {ridge, ratio, now, classifiers};
        }
    }
    return best;
}

}  // namespace

void pool(const LinearExpert& expert, const FeatureMatrix& features, std::span<const std::uint32_t> stump_only_labels,
          std::span<float> probabilities) {
    if (!expert.used()) return;
    const std::vector<float> stumps(probabilities.begin(), probabilities.end());
    const std::size_t classes = expert.classifier.class_count;
    std::vector<float> linear(probabilities.size());
    linear_scores(expert.classifier, features, linear);
    hold_to_targets(linear);
    for (std::size_t i = 0; i < linear.size(); ++i)
        probabilities[i] = log_of(probabilities[i]) + expert.ratio * linear[i];
    scores_to_probabilities(probabilities, classes, Link::softmax, expert.scale);
    copy_class_probabilities(stump_only_labels, classes, stumps, probabilities);
}

std::optional<FoldedLinear> fit_linear(const LinearRows& data, std::span<const float> stumps,
                                       std::span<const float> loss_weight, const std::vector<bool>& excluded_folds) {
    const HeldOutRows held = hold_out(data, stumps, loss_weight);
    if (!tells_labels_apart(held)) return std::nullopt;
    const LinearTraining training(data);
    const Calibration alone = calibrate(held.log_stumps, held.label, held.weight, data.classes, k_pooled_links);
    const Choice choice = choose(data, held, training, alone);
    if (choice.ratio == 0) return std::nullopt;

    FoldedLinear result{{}, {}, choice.ridge, choice.calibration.loss, choice.calibration.error, alone.loss};
    std::vector<LinearClassifier> heard{training.solve(choice.ridge)};
    for (std::size_t fold = 0; fold < choice.without_fold.size(); ++fold) {
        result.without_fold.push_back({choice.without_fold[fold], choice.ratio, choice.calibration.scale});
        if (!excluded_folds[fold]) heard.push_back(choice.without_fold[fold]);
    }
    result.mean = {mean_linear(heard), choice.ratio, choice.calibration.scale};
    return result;
}

}  // namespace exemplar
