#include "host/labeling/training/fold_boosting.h"

#include <gtest/gtest.h>

#include "tests/learn/boosting/boosting_data.h"

namespace exemplar {
namespace {

struct Meshes {
    std::vector<Data> data;
    std::vector<std::vector<std::uint8_t>> fold;
    std::vector<BoostingItems> items;
};

/// `count` meshes of two classes, each held out by a fold of its own.
Meshes make_meshes(std::size_t count, std::size_t rows, double noise) {
    Meshes meshes;
    for (std::size_t m = 0; m < count; ++m) {
        meshes.data.push_back(make_data(rows, 12, 2, noise, 100 + m));
        meshes.fold.emplace_back(rows, static_cast<std::uint8_t>(m));
    }
    for (std::size_t m = 0; m < count; ++m)
        meshes.items.push_back({[&matrix = meshes.data[m].features]() -> const FeatureMatrix& { return matrix; },
                                meshes.data[m].labels, meshes.data[m].weights, meshes.fold[m]});
    return meshes;
}

FoldBoostingOptions options_for(std::size_t folds) {
    FoldBoostingOptions options;
    options.features = 12, options.folds = folds, options.rounds = 200, options.patience = 20;
    return options;
}

TEST(FoldBoosting, EndsSoonAfterTheHeldOutLossIsLeast) {
    const Meshes meshes = make_meshes(3, 60, 3.0);  // noise is soon learned by heart
    const FoldBoostingOptions options = options_for(3);
    CpuStumpScorer scorer;
    std::size_t rounds = 0;
    const FoldBoostingResult result = boost_with_folds(meshes.items, options, scorer, [&] { ++rounds; });
    const std::size_t best = result.rounds;
    EXPECT_EQ(result.classifier.stumps.stumps.size(), 4 * best) << "the folds' classifiers and that of all meshes";
    ASSERT_LT(best, 150U);
    for (const HeldOutPoint& point : result.curve) EXPECT_GE(point.loss, result.loss);
    EXPECT_LE(result.curve.back().rounds, best + options.patience + 10);  // judged every ten rounds
    EXPECT_EQ(rounds, 4 * result.curve.back().rounds) << "no classifier went on after the search had ended";
}

TEST(FoldBoosting, KeepsAllRoundsWithoutPatience) {
    const Meshes meshes = make_meshes(3, 60, 3.0);
    FoldBoostingOptions options = options_for(3);
    options.patience = 0;
    CpuStumpScorer scorer;
    const FoldBoostingResult result = boost_with_folds(meshes.items, options, scorer, [] {});
    EXPECT_EQ(result.rounds, options.rounds);
    EXPECT_EQ(result.loss, result.curve.back().loss) << "the calibration is that of the last round";
    std::vector<std::size_t> judged;
    for (const HeldOutPoint& point : result.curve) judged.push_back(point.rounds);
    EXPECT_EQ(judged, (std::vector<std::size_t>{1, 2, 4, 8, 16, 32, 64, 128, 200}));
}

TEST(FoldBoosting, ProbabilitiesAreOfTheClassifierThatNeverSawTheMesh) {
    Meshes meshes = make_meshes(3, 80, 1.0);
    FoldBoostingOptions options = options_for(3);
    options.rounds = 1;
    CpuStumpScorer scorer;
    const auto likelier = [&] {
        std::vector<bool> first;
        const FoldBoostingResult result = boost_with_folds(meshes.items, options, scorer, [] {});
        for (std::size_t i = 0; i < 80; ++i) first.push_back(result.out_of_fold[0][2 * i] > 0.5F);
        return first;
    };
    const std::vector<bool> straight = likelier();
    EXPECT_NE(straight, std::vector<bool>(80, straight[0]));
    // Other labels of a held-out mesh change how it is judged, but not which class it is given.
    for (std::int32_t& label : meshes.data[0].labels) label = 1 - label;
    EXPECT_EQ(likelier(), straight);
}

TEST(FoldBoosting, ALabelOfOneFoldOnlyIsNotHeldAgainstTheOthers) {
    Meshes meshes = make_meshes(3, 80, 0.2);
    CpuStumpScorer scorer;
    FoldBoostingOptions options = options_for(3);
    options.classes = 3, options.patience = 0, options.rounds = 60;
    const FoldBoostingResult before = boost_with_folds(meshes.items, options, scorer, [] {});
    for (std::size_t i = 0; i < 30; ++i) meshes.data[0].labels[i] = 2;  // what no classifier without this mesh can know
    const FoldBoostingResult after = boost_with_folds(meshes.items, options, scorer, [] {});
    EXPECT_TRUE(before.single_fold_labels.empty());
    EXPECT_EQ(after.single_fold_labels, std::vector<std::uint32_t>{2});
    EXPECT_EQ(before.classifier.stumps.stumps.size(), 4 * 60U);
    EXPECT_EQ(after.classifier.stumps.stumps.size(), 3 * 60U) << "the one that cannot know the label has no say";
    EXPECT_LT(after.error, before.error + 0.1);
    EXPECT_GT(after.classifier.scale, 0.5F * before.classifier.scale) << "probabilities must not become unsure";
}

TEST(FoldBoosting, ContextShowsALabelOfOneFoldOnlyWithLessConfidence) {
    Meshes meshes = make_meshes(3, 80, 0.2);
    for (std::size_t i = 0; i < 30; ++i) {
        meshes.data[0].labels[i] = 2;
        meshes.data[0].features.column(0)[i] = 50.0F;  // easy to learn
    }
    CpuStumpScorer scorer;
    FoldBoostingOptions options = options_for(3);
    options.classes = 3, options.patience = 0, options.rounds = 60;
    const FoldBoostingResult result = boost_with_folds(meshes.items, options, scorer, [] {});
    std::vector<float> seen(80 * 3), held_out = result.out_of_fold[0];
    scorer.probabilities(result.classifier.stumps, meshes.data[0].features, result.classifier.link,
                         result.classifier.scale, seen);
    float least = 1;
    for (std::size_t i = 0; i < 80; ++i) {
        const float* p = held_out.data() + 3 * i;
        EXPECT_NEAR(p[0] + p[1] + p[2], 1, 1e-5);
        const bool is_rare = i < 30;
        EXPECT_EQ(is_rare, *std::max_element(p, p + 3) == p[2]) << "item " << i;
        if (!is_rare) continue;
        EXPECT_LE(p[2], seen[3 * i + 2]);
        least = std::min(least, p[2]);
    }
    EXPECT_LT(least, 0.999F);
    float elsewhere = 0;
    for (std::size_t i = 0; i < 80; ++i) elsewhere += result.out_of_fold[1][3 * i + 2] / 80;
    EXPECT_LT(elsewhere, 0.05F) << "known, and not there";
}

TEST(FoldBoosting, FewRowsOfEachMeshStillShowItsSmallLabels) {
    Meshes meshes = make_meshes(3, 2000, 0.2);
    for (Data& mesh : meshes.data)
        for (std::size_t i = 0; i < 2000; ++i) {
            mesh.labels[i] = i < 6 ? 1 : 0;  // few of 40 random rows would have label 1
            mesh.features.column(0)[i] = i < 6 ? 50.0F : 0.0F;
        }
    CpuStumpScorer scorer;
    FoldBoostingOptions options = options_for(3);
    options.patience = 0, options.rounds = 30, options.rows_per_mesh = 40;
    const FoldBoostingResult result = boost_with_folds(meshes.items, options, scorer, [] {});
    for (const std::vector<float>& p : result.out_of_fold)
        for (std::size_t i = 0; i < 2000; ++i) ASSERT_GT(p[2 * i + (i < 6 ? 1 : 0)], 0.5F) << i;
    EXPECT_LT(result.loss, 0.1);
}

TEST(FoldBoosting, WithoutAnythingHeldOutItStillTrains) {
    const Meshes meshes = make_meshes(1, 60, 1.0);
    CpuStumpScorer scorer;
    const FoldBoostingResult result = boost_with_folds(meshes.items, options_for(1), scorer, [] {});
    EXPECT_EQ(result.classifier.stumps.stumps.size(), 50U);
    EXPECT_TRUE(result.curve.empty());
    EXPECT_EQ(result.out_of_fold[0].size(), 120U);
}

}  // namespace
}  // namespace exemplar
