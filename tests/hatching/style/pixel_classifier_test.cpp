#include "host/hatching/style/pixel_classifier.h"

#include <gtest/gtest.h>

#include "host/core/random.h"

namespace {

using namespace exemplar;

constexpr std::size_t k_labeled_rows = 4000, k_rows_of_a_run = 100, k_label_folds = 4;

/// Rows in order along a line, in runs of a hundred that share a label by chance: what is learned of a run tells
/// nothing of another.
struct RandomRuns {
    FeatureMatrix features;
    std::vector<std::int32_t> labels;
    std::vector<std::uint8_t> fold, held_out;
};

RandomRuns random_runs() {
    RandomRuns runs;
    runs.features.rows = k_labeled_rows;
    const std::span<float> place = runs.features.add("place");
    Random random(7);
    for (std::size_t i = 0; i < k_labeled_rows; ++i) {
        place[i] = static_cast<float>(i);
        const std::size_t run = i / k_rows_of_a_run;
        if (i % k_rows_of_a_run == 0) runs.labels.push_back(random.uniform() < 0.5 ? 0 : 1);
        if (i % k_rows_of_a_run != 0) runs.labels.push_back(runs.labels.back());
        runs.fold.push_back(static_cast<std::uint8_t>(run % k_label_folds));
        runs.held_out.push_back(i % 4 == 0 ? 1 : 0);
    }
    return runs;
}

/// The share of rows whose label a classifier tells: of those in a fold, and of the others.
std::array<double, 2> share_told(const CalibratedStumps& classifier, const RandomRuns& runs, std::size_t fold) {
    CpuStumpScorer scorer;
    const std::array<std::uint32_t, 1> which{0};
    const std::vector<float> probabilities = classify(classifier, which, runs.features, scorer);
    std::array<double, 2> right{}, all{};
    for (std::size_t i = 0; i < k_labeled_rows; ++i) {
        const std::size_t set = runs.fold[i] == fold ? 0 : 1;
        right[set] += (probabilities[2 * i + 1] > 0.5f) == (runs.labels[i] == 1) ? 1 : 0;
        all[set] += 1;
    }
    return {right[0] / all[0], right[1] / all[1]};
}

// A classifier that has not learned from a fold knows nothing of its labels if these are chance; one that has learned
// from all rows knows them all. This is why contextual features come from the former.
TEST(PixelClassifier, WithoutFoldsNothingOfThemIsKnown) {
    const RandomRuns runs = random_runs();
    const ClassifierTraining training{.features = runs.features,
                                      .labels = runs.labels,
                                      .weights = {},
                                      .held_out = runs.held_out,
                                      .classes = 2,
                                      .max_rounds = 400};
    const LearnedClassifier all = learn_classifier(training);
    const std::vector<CalibratedStumps> without =
        learn_without_folds(training, all.classifier, runs.fold, k_label_folds);
    ASSERT_EQ(without.size(), k_label_folds);
    EXPECT_GT(share_told(all.classifier, runs, 0)[0], 0.85);
    double seen = 0, unseen = 0;
    for (std::size_t fold = 0; fold < k_label_folds; ++fold) {
        EXPECT_EQ(without[fold].stumps.stumps.size(), all.classifier.stumps.stumps.size());
        const auto [in_fold, elsewhere] = share_told(without[fold], runs, fold);
        unseen += in_fold / k_label_folds;
        seen += elsewhere / k_label_folds;
    }
    EXPECT_LT(unseen, 0.65);
    EXPECT_GT(seen, 0.85);
}

// A fold of which there are no rows leaves the classifier as it is.
TEST(PixelClassifier, AFoldWithoutRowsChangesNothing) {
    RandomRuns runs = random_runs();
    const ClassifierTraining training{
        .features = runs.features, .labels = runs.labels, .weights = {}, .held_out = runs.held_out, .max_rounds = 20};
    const LearnedClassifier all = learn_classifier(training);
    std::ranges::fill(runs.fold, std::uint8_t{0});
    const std::vector<CalibratedStumps> without = learn_without_folds(training, all.classifier, runs.fold, 2);
    EXPECT_EQ(share_told(without[1], runs, 0)[0], share_told(all.classifier, runs, 0)[0]);
    // No rows are left to learn from without the only fold.
    EXPECT_EQ(share_told(without[0], runs, 0)[0], share_told(all.classifier, runs, 0)[0]);
}

}  // namespace
