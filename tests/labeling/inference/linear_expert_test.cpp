#include "host/labeling/inference/linear_expert.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "host/core/random.h"

namespace exemplar {
namespace {

constexpr std::size_t k_rows = 3000, k_inputs = 20, k_classes = 2, k_folds = 3;

/// Labels that a sum of many features tells, none of which tells much; every third row is held out together.
struct PooledData {
    FeatureMatrix features;
    std::vector<std::uint32_t> rows = std::vector<std::uint32_t>(k_rows);
    std::vector<std::int32_t> label;
    std::vector<float> weight = std::vector<float>(k_rows, 1.0F);
    std::vector<std::uint8_t> fold;

    PooledData() {
        Random random(8);
        features.rows = k_rows;
        for (std::size_t f = 0; f < k_inputs; ++f)
            for (float& value : features.add("a." + std::to_string(f))) value = static_cast<float>(random.normal());
        std::iota(rows.begin(), rows.end(), 0U);
        for (std::size_t i = 0; i < k_rows; ++i) {
            float sum = 0;
            for (std::size_t f = 0; f < k_inputs; ++f) sum += features.column(f)[i];
            label.push_back(sum > 0);
            fold.push_back(static_cast<std::uint8_t>(i % k_folds));
        }
    }
    LinearRows all() const { return {features, rows, label, weight, fold, k_classes, k_folds}; }
    /// Stumps that are right with the same probability everywhere, and say so.
    std::vector<float> stumps(float sure) const {
        Random random(9);
        std::vector<float> p;
        for (std::size_t i = 0; i < k_rows; ++i) {
            const bool right = random.uniform() < static_cast<double>(sure);
            const float one = (label[i] == 1) == right ? sure : 1 - sure;
            p.insert(p.end(), {1 - one, one});
        }
        return p;
    }
};

const std::vector<bool> k_all_speak(k_folds, false);

double share_right(const PooledData& data, const std::vector<float>& p) {
    double right = 0;
    for (std::size_t i = 0; i < k_rows; ++i) right += (p[2 * i + 1] > p[2 * i]) == (data.label[i] == 1);
    return right / k_rows;
}

double loss_of(const PooledData& data, const std::vector<float>& p) {
    double loss = 0;
    for (std::size_t i = 0; i < k_rows; ++i) loss -= std::log(0.99 * double{p[2 * i + data.label[i]]} + 0.005);
    return loss / k_rows;
}

TEST(LinearExpert, AddsWhatStumpsMiss) {
    const PooledData data;
    const std::vector<float> stumps = data.stumps(0.7F);
    const auto fit = fit_linear(data.all(), stumps, data.weight, k_all_speak);
    ASSERT_TRUE(fit);
    EXPECT_LT(fit->loss, loss_of(data, stumps));
    std::vector<float> pooled = stumps;
    pool(fit->mean, data.features, {}, pooled);
    EXPECT_GT(share_right(data, pooled), 0.95);
    for (std::size_t i = 0; i < k_rows; ++i) EXPECT_NEAR(pooled[2 * i] + pooled[2 * i + 1], 1, 1e-5);
}

TEST(LinearExpert, HasTheLossOfClassifiersThatNeverSawTheRows) {
    const PooledData data;
    const std::vector<float> stumps = data.stumps(0.7F);
    const auto fit = fit_linear(data.all(), stumps, data.weight, k_all_speak);
    ASSERT_TRUE(fit);
    std::vector<float> held_out(k_rows * k_classes);
    for (std::size_t fold = 0; fold < k_folds; ++fold) {
        std::vector<float> pooled = stumps;
        pool(fit->without_fold[fold], data.features, {}, pooled);
        for (std::size_t i = 0; i < k_rows; ++i)
            if (data.fold[i] == fold) std::copy_n(pooled.begin() + 2 * i, 2, held_out.begin() + 2 * i);
    }
    EXPECT_NEAR(fit->loss, loss_of(data, held_out), 1e-3);
}

TEST(LinearExpert, LeavesStumpsAloneThatKnowAll) {
    const PooledData data;
    std::vector<float> stumps;
    for (const std::int32_t label : data.label) {
        const float one = label == 1 ? 1.0F : 0.0F;
        stumps.insert(stumps.end(), {1 - one, one});
    }
    EXPECT_FALSE(fit_linear(data.all(), stumps, data.weight, k_all_speak));
}

TEST(LinearExpert, LeavesStumpsAloneWhereFeaturesTellNothing) {
    PooledData data;
    const std::vector<float> stumps = data.stumps(0.9F);
    Random random(4);
    for (float& value : data.features.values) value = static_cast<float>(random.normal());
    const auto fit = fit_linear(data.all(), stumps, data.weight, k_all_speak);
    if (!fit) return;
    EXPECT_GT(fit->loss, loss_of(data, stumps) - 0.01);  // by chance
}

TEST(LinearExpert, NothingIsChosenWhereNothingCanBeJudged) {
    const PooledData data;
    const std::vector<float> none(k_rows, 0.0F);
    EXPECT_FALSE(fit_linear(data.all(), data.stumps(0.7F), none, k_all_speak));
    std::vector<float> one_label(k_rows);
    for (std::size_t i = 0; i < k_rows; ++i) one_label[i] = data.label[i] == 1 ? 1.0F : 0.0F;
    EXPECT_FALSE(fit_linear(data.all(), data.stumps(0.7F), one_label, k_all_speak));
}

TEST(LinearExpert, FoldsWithoutSayAreNotInTheMean) {
    const PooledData data;
    const std::vector<float> stumps = data.stumps(0.7F);
    const auto fit = fit_linear(data.all(), stumps, data.weight, {true, true, true});
    ASSERT_TRUE(fit);
    const LinearClassifier all = LinearTraining(data.all()).solve(fit->ridge);
    EXPECT_EQ(fit->mean.classifier.weight, all.weight);
}

TEST(LinearExpert, NotUsedItChangesNothing) {
    const PooledData data;
    const std::vector<float> stumps = data.stumps(0.7F);
    std::vector<float> pooled = stumps;
    pool({}, data.features, {}, pooled);
    EXPECT_EQ(pooled, stumps);
}

// Features of a mesh unlike those of training may no longer go together: L of a whole mesh was 1.5 for one label and
// -0.7 for another, and a person all torso.
TEST(LinearExpert, BeyondItsTargetsALinearClassifierSaysNoMore) {
    FeatureMatrix features;
    features.rows = 3;
    const std::vector<float> values{0, 1, 4};
    std::ranges::copy(values, features.add("a.0").begin());
    LinearExpert expert;
    expert.classifier = {2, {0}, {1}, {1, -1}, {0, 1}};  // L is 0 and 1; 1 and 0; 4 and -3
    expert.ratio = 3;
    std::vector<float> probabilities{0.5F, 0.5F, 0.5F, 0.5F, 0.5F, 0.5F};
    pool(expert, features, {}, probabilities);
    const float sure = 1 / (1 + std::exp(-3.0F));
    const std::vector<float> expected{1 - sure, sure, sure, 1 - sure, sure, 1 - sure};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(probabilities[i], expected[i], 1e-6F) << i;
}

TEST(LinearExpert, LabelsThatCannotBeJudgedKeepWhatStumpsSay) {
    const PooledData data;
    const std::vector<float> stumps = data.stumps(0.7F);
    const auto fit = fit_linear(data.all(), stumps, data.weight, k_all_speak);
    ASSERT_TRUE(fit);
    std::vector<float> pooled = stumps;
    const std::vector<std::uint32_t> stump_only_labels{1};
    pool(fit->mean, data.features, stump_only_labels, pooled);
    for (std::size_t i = 0; i < pooled.size(); ++i) EXPECT_NEAR(pooled[i], stumps[i], 1e-6);
}

}  // namespace
}  // namespace exemplar
