#include "host/labeling/inference/linear_opinion.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/labeling/inference/cascade_opinion.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/learn/boosting/calibration.h"

namespace exemplar {
namespace {

constexpr std::array<double, 4> k_ridges{1e-4, 1e-3, 1e-2, 1e-1};
constexpr std::array<float, 6> k_ratios{0.5F, 1, 2, 4, 8, 16};
/// Probabilities of stumps are no less in their logarithm; a label that a fold never saw has none.
constexpr float k_least_probability = 1e-6F;
constexpr std::array<Link, 1> k_links{Link::softmax};

float log_of(float probability) {
    return std::log(std::max(probability, k_least_probability));
}

/// L is fitted to targets of 0 and 1: what lies beyond says no more, and of a mesh unlike those of training, whose
/// features no longer go together as they did, it may lie far beyond.
void hold_to_targets(std::span<float> linear) {
    for (float& value : linear) value = std::clamp(value, 0.0F, 1.0F);
}

/// The held-out rows of all folds one after the other, and what is known of them.
struct HeldOut {
    std::vector<std::vector<std::uint32_t>> of_fold;
    std::vector<std::int32_t> label;
    std::vector<float> weight, log_stumps;
};

HeldOut hold_out(const LinearRows& data, std::span<const float> stumps, std::span<const float> judged) {
    HeldOut held{std::vector<std::vector<std::uint32_t>>(data.fold_count), {}, {}, {}};
    for (const std::uint32_t row : data.rows) held.of_fold[data.fold[row]].push_back(row);
    for (const std::vector<std::uint32_t>& rows : held.of_fold)
        for (const std::uint32_t row : rows) {
            held.label.push_back(data.label[row]);
            held.weight.push_back(judged[row]);
            for (const float p : stumps.subspan(row * data.classes, data.classes)) held.log_stumps.push_back(log_of(p));
        }
    return held;
}

/// Whether rows of two labels are judged: of one alone, whoever is surest would be best.
bool tells_labels_apart(const HeldOut& held) {
    std::int32_t first = -1;
    for (std::size_t i = 0; i < held.label.size(); ++i) {
        if (!(held.weight[i] > 0)) continue;
        if (first >= 0 && held.label[i] != first) return true;
        first = held.label[i];
    }
    return false;
}

/// L of all held-out rows, each from the classifier of the other folds.
std::vector<float> held_out_scores(const LinearRows& data, const HeldOut& held,
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

/// The best way found to pool; ratio 0: stumps alone.
struct Choice {
    double ridge = 0;
    float ratio = 0;
    Calibration calibration;
    std::vector<LinearClassifier> without_fold;
};

Choice choose(const LinearRows& data, const HeldOut& held, const LinearTraining& training,
              const Calibration& stumps_alone) {
    Choice best{0, 0, stumps_alone, {}};
    std::vector<float> pooled(held.log_stumps.size());
    for (const double ridge : k_ridges) {
        check_interrupt();
        const std::vector<LinearClassifier> classifiers = solve_without_folds(training, ridge, data.fold_count);
        const std::vector<float> linear = held_out_scores(data, held, classifiers);
        for (const float ratio : k_ratios) {
            for (std::size_t i = 0; i < pooled.size(); ++i) pooled[i] = held.log_stumps[i] + ratio * linear[i];
            const Calibration now = calibrate(pooled, held.label, held.weight, data.classes, k_links);
            if (now.loss < best.calibration.loss) best = {ridge, ratio, now, classifiers};
        }
    }
    return best;
}

}  // namespace

void pool(const LinearOpinion& opinion, const FeatureMatrix& features, std::span<const std::uint32_t> unjudged,
          std::span<float> probabilities) {
    if (!opinion.used()) return;
    const std::vector<float> stumps(probabilities.begin(), probabilities.end());
    const std::size_t classes = opinion.classifier.class_count;
    std::vector<float> linear(probabilities.size());
    linear_scores(opinion.classifier, features, linear);
    hold_to_targets(linear);
    for (std::size_t i = 0; i < linear.size(); ++i)
        probabilities[i] = log_of(probabilities[i]) + opinion.ratio * linear[i];
    scores_to_probabilities(probabilities, classes, Link::softmax, opinion.scale);
    take_classes(unjudged, classes, stumps, probabilities);
}

std::optional<FoldedLinear> fit_linear(const LinearRows& data, std::span<const float> stumps,
                                       std::span<const float> judged, const std::vector<bool>& silent) {
    const HeldOut held = hold_out(data, stumps, judged);
    if (!tells_labels_apart(held)) return std::nullopt;
    const LinearTraining training(data);
    const Calibration alone = calibrate(held.log_stumps, held.label, held.weight, data.classes, k_links);
    const Choice choice = choose(data, held, training, alone);
    if (choice.ratio == 0) return std::nullopt;

    FoldedLinear result{{}, {}, choice.ridge, choice.calibration.loss, choice.calibration.error, alone.loss};
    std::vector<LinearClassifier> heard{training.solve(choice.ridge)};
    for (std::size_t fold = 0; fold < choice.without_fold.size(); ++fold) {
        result.without_fold.push_back({choice.without_fold[fold], choice.ratio, choice.calibration.scale});
        if (!silent[fold]) heard.push_back(choice.without_fold[fold]);
    }
    result.mean = {mean_linear(heard), choice.ratio, choice.calibration.scale};
    return result;
}

}  // namespace exemplar
