#include "host/labeling/painting/folder_simulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/labeling/painting/folder_learning.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A body with a thinner snout along +x, label 1. `length` is that of the snout.
LabeledMesh snouted_ball(const std::string& name, float length) {
    LabeledMesh ball{name, {}, shapes::icosphere(3, 1.0F), {}};
    for (Vec3& v : ball.mesh.vertices)
        if (v.x() > 0.7F) v = Vec3(v.x() + length * (v.x() - 0.7F) / 0.3F, 0.5F * v.y(), 0.5F * v.z());
    for (const Vec3& center : face_centers(ball.mesh)) ball.label.push_back(center.x() > 0.75F ? 1 : 0);
    return ball;
}

struct Folder {
    LabeledCorpus corpus{{"body", "snout"}, {}, {}};
    std::vector<MeshFeatures> features;
    CpuStumpScorer scorer;
    CpuContextHistograms context;
    explicit Folder(std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) {
            corpus.meshes.push_back(snouted_ball("ball" + std::to_string(i), 0.5F + 0.1F * static_cast<float>(i)));
            features.push_back(compute_features(corpus.meshes.back().mesh, suggestion_training().features));
        }
    }
    SimulationResult run(LabelingWay way, SimulationOptions options = {}) {
        return FolderSimulation(corpus, features, {scorer, context}, options).run(way);
    }
};

TEST(FolderSimulation, EachShapeAloneCostsItsActions) {
    Folder folder(3);
    SimulationOptions options;
    options.costs = {.open = 100, .stroke = 10, .verify = 1, .face = 1};
    const SimulationResult result = folder.run(LabelingWay::each_alone, options);
    const SimulationState& last = result.states.back();
    EXPECT_EQ(last.verified, 3u);
    EXPECT_GE(last.strokes, 3u * 2) << "a stroke on each part at least";
    EXPECT_DOUBLE_EQ(last.seconds, 3 * 101 + 10 * static_cast<double>(last.strokes));
    EXPECT_GE(last.right, 0.95);
    for (std::size_t i = 1; i < result.states.size(); ++i)
        EXPECT_GE(result.states[i].seconds, result.states[i - 1].seconds);
    EXPECT_EQ(result.seconds_until(0.0), result.states.front().seconds);
    EXPECT_EQ(result.seconds_until(2.0), last.seconds) << "never";
}

TEST(FolderSimulation, AModelSparesStrokes) {
    Folder folder(5);
    const SimulationResult alone = folder.run(LabelingWay::each_alone);
    for (const LabelingWay way : {LabelingWay::random_order, LabelingWay::order_by_gain}) {
        const SimulationResult learned = folder.run(way);
        EXPECT_GE(learned.states.back().right, 0.95);
        EXPECT_LT(learned.states.back().strokes, alone.states.back().strokes);
        EXPECT_LT(learned.seconds_until(0.95), 0.8 * alone.seconds_until(0.95));
        EXPECT_EQ(folder.run(way).states.back().seconds, learned.states.back().seconds) << "again the same";
    }
    for (const MeshFeatures& mesh : folder.features)
        EXPECT_EQ(mesh.unary.cols(), folder.features.front().unary.cols()) << "no columns of context are left behind";
}

TEST(Suggestions, ARejectedOneIsMuchTheSameUntilOneFaceInTwentyChanges) {
    std::vector<std::int32_t> rejected(100, 0), now = rejected;
    EXPECT_TRUE(much_the_same(rejected, now));
    for (std::size_t f = 0; f < 4; ++f) now[f] = 1;
    EXPECT_TRUE(much_the_same(rejected, now));
    now[4] = 1;
    EXPECT_FALSE(much_the_same(rejected, now));
    EXPECT_FALSE(much_the_same({}, now)) << "none was rejected";
}

TEST(FolderLearning, NeedsTwoLabels) {
    Folder folder(1);
    EXPECT_EQ(learn_from_verified({}, {}, {folder.scorer, folder.context}), nullptr);
    LabeledCorpus corpus = folder.corpus;
    corpus.meshes.front().label.assign(corpus.meshes.front().label.size(), 1);
    const LabeledCorpus used = without_unused_labels(std::move(corpus));
    EXPECT_EQ(used.names, std::vector<std::string>{"snout"});
    EXPECT_EQ(used.meshes.front().label.front(), 0);
}

}  // namespace
}  // namespace exemplar
