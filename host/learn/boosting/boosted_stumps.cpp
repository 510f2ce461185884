#include "host/learn/boosting/boosted_stumps.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/learn/boosting/grouped_stumps.h"
#include "host/learn/softmax.h"

namespace exemplar {
namespace {

constexpr std::size_t k_scoring_block = 256;  // rows scored together: H of a block stays in the first-level cache

/// A classifier prepared for summation: the stumps that share the same classes give one sum for all of them.
struct Sum {
    std::uint32_t class_count;
    GroupedStumps grouped;
    std::vector<float> constant;

    explicit Sum(const BoostedStumps& classifier)
        : class_count(classifier.class_count), grouped(classifier), constant(classifier.constant()) {}
};

/// Computes H of rows [begin, begin + count), class-major with stride k_scoring_block.
void sum_stumps(const Sum& sum, const FeatureMatrix& features, std::size_t begin, std::size_t count,
                std::span<float> h) {
    for (std::size_t c = 0; c < sum.class_count; ++c)
        std::fill_n(h.data() + c * k_scoring_block, count, sum.constant[c]);
    std::array<float, k_scoring_block> response;
    for (const GroupedStumps::Group& group : sum.grouped.groups) {
        response.fill(0.0f);
        for (std::size_t m = group.first; m < group.end; ++m) {
            const Stump stump = sum.grouped.stumps[m];
            const float* x = features.column(stump.feature).data() + begin;
            for (std::size_t i = 0; i < count; ++i) response[i] += x[i] > stump.threshold ? stump.above : stump.below;
        }
        for (std::uint64_t left = group.classes; left != 0; left &= left - 1) {
            float* of_class = h.data() + static_cast<std::size_t>(std::countr_zero(left)) * k_scoring_block;
            for (std::size_t i = 0; i < count; ++i) of_class[i] += response[i];
        }
    }
}

/// Returns the log of the unnormalized probability: s H for the softmax, log sigma(s H) for the sigmoid.
float log_weight(float scaled, Link link) {
    return link == Link::softmax ? scaled : log_logistic(scaled);
}

void score_rows(const Sum& sum, const FeatureMatrix& features, Link link, float scale, std::span<float> out) {
    const std::size_t classes = sum.class_count;
    const std::size_t blocks = (features.rows + k_scoring_block - 1) / k_scoring_block;
    parallel_ranges(blocks, 1, [&](std::size_t first, std::size_t last) {
        std::vector<float> h(classes * k_scoring_block);
        for (std::size_t begin = first * k_scoring_block; begin < std::min(last * k_scoring_block, features.rows);
             begin += k_scoring_block) {
            const std::size_t count = std::min(k_scoring_block, features.rows - begin);
            sum_stumps(sum, features, begin, count, h);
            for (std::size_t i = 0; i < count; ++i) {
                const std::span<float> row = out.subspan((begin + i) * classes, classes);
                for (std::size_t c = 0; c < classes; ++c) row[c] = log_weight(scale * h[c * k_scoring_block + i], link);
                softmax(row);
            }
        }
    });
}

}  // namespace

void scores_to_probabilities(std::span<float> scores, std::size_t classes, Link link, float scale) {
    parallel_for(
        scores.size() / classes,
        [&](std::size_t i) {
            const std::span<float> row = scores.subspan(i * classes, classes);
            for (float& h : row) h = log_weight(scale * h, link);
            softmax(row);
        },
        k_scoring_block);
}

BoostedStumps mean_classifier(std::span<const BoostedStumps> classifiers) {
    BoostedStumps mean;
    mean.class_count = classifiers.front().class_count;
    const float share = 1.0F / static_cast<float>(classifiers.size());
    for (const BoostedStumps& classifier : classifiers) {
        for (Stump stump : classifier.stumps) {
            stump.above *= share, stump.below *= share;
            mean.stumps.push_back(stump);
        }
        for (const float constant : classifier.elsewhere) mean.elsewhere.push_back(constant * share);
    }
    return mean;
}

std::vector<float> BoostedStumps::constant() const {
    std::vector<double> sum(class_count, 0.0);
    for (std::size_t m = 0; m < stumps.size(); ++m) {
        for (std::size_t c = 0; c < class_count; ++c) sum[c] += static_cast<double>(elsewhere[m * class_count + c]);
    }
    return std::vector<float>(sum.begin(), sum.end());
}

void check_scoring(const BoostedStumps& classifier, const FeatureMatrix& features, float scale,
                   std::span<const float> out) {
    const std::size_t classes = classifier.class_count;
    if (classes == 0 || classes > k_max_classes) {
        throw ModelError("the classifier has " + std::to_string(classes) + " classes, but 1 to " +
                         std::to_string(k_max_classes) + " are possible; train it again");
    }
    if (classifier.elsewhere.size() != classifier.stumps.size() * classes) {
        throw ModelError("the classifier has " + std::to_string(classifier.elsewhere.size()) +
                         " constants k_c, but its " + std::to_string(classifier.stumps.size()) + " stumps of " +
                         std::to_string(classes) + " classes need one each; train it again");
    }
    for (std::size_t m = 0; m < classifier.stumps.size(); ++m) {
        const Stump& stump = classifier.stumps[m];
        if (stump.feature >= features.cols()) {
            throw ModelError("stump " + std::to_string(m) + " needs feature " + std::to_string(stump.feature) +
                             ", but there are " + std::to_string(features.cols()) +
                             "; use the features it was trained on");
        }
        if (classes < 64 && (stump.classes >> classes) != 0) {
            throw ModelError("stump " + std::to_string(m) + " is shared by a class beyond the classifier's " +
                             std::to_string(classes) + "; train it again");
        }
    }
    if (out.size() != features.rows * classes) {
        throw UsageError("the output holds " + std::to_string(out.size()) + " values, but " +
                         std::to_string(features.rows) + " rows x " + std::to_string(classes) + " classes are needed");
    }
    if (!(scale > 0.0f)) throw UsageError("the link's scale is " + std::to_string(scale) + "; it must be above zero");
}

void CpuStumpScorer::probabilities_of_all(const BoostedStumps& classifier, Link link, float scale,
                                          std::span<const ScoredMatrix> matrices) {
    for (const ScoredMatrix& matrix : matrices) check_scoring(classifier, *matrix.features, scale, matrix.out);
    const Sum sum(classifier);
    for (const ScoredMatrix& matrix : matrices) score_rows(sum, *matrix.features, link, scale, matrix.out);
}

}  // namespace exemplar
