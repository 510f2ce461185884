#include "host/labeling/inference/cascade_prediction.h"

#include <gtest/gtest.h>

namespace exemplar {
namespace {

TEST(CascadePrediction, TakesSomeClassesFromAnotherStage) {
    const std::vector<std::uint32_t> taken{1};
    const std::vector<float> source{0.1F, 0.8F, 0.1F, 0.5F, 0.0F, 0.5F, 0.0F, 0.4F, 0.6F};
    std::vector<float> target{0.3F, 0.4F, 0.3F, 0.2F, 0.6F, 0.2F, 0.0F, 1.0F, 0.0F};
    copy_class_probabilities(taken, 3, source, target);
    const std::vector<float> expected{0.1F, 0.8F, 0.1F, 0.5F, 0.0F, 0.5F, 0.3F, 0.4F, 0.3F};
    for (std::size_t i = 0; i < target.size(); ++i) EXPECT_NEAR(target[i], expected[i], 1e-6) << i;
    const std::vector<float> before = target;
    copy_class_probabilities({}, 3, source, target);
    EXPECT_EQ(target, before);
}

/// One item, three classes; the mean of all stages for the last one, the others share what is left of the newest stage.
TEST(CascadePrediction, IsTheMeanOfAllStagesForSomeClasses) {
    const std::vector<std::uint32_t> averaged{2};
    CascadePrediction prediction(averaged, 3);
    const auto add = [&](std::vector<float> stage) {
        prediction.add_stage(stage);
        return stage;
    };
    const auto expect = [](const std::vector<float>& values, const std::vector<float>& expected) {
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(values[c], expected[c], 1e-6) << c;
    };
    expect(add({0.1F, 0.0F, 0.9F}), {0.1F, 0.0F, 0.9F});
    expect(add({0.6F, 0.2F, 0.2F}), {0.3375F, 0.1125F, 0.55F});
    expect(add({0.2F, 0.7F, 0.1F}), {0.6F / 4.5F, 2.1F / 4.5F, 0.4F});
}

TEST(CascadePrediction, IsTheLastStageWhereNothingIsAveraged) {
    CascadePrediction prediction({}, 2);
    for (const std::vector<float>& stage : {std::vector{0.25F, 0.75F}, std::vector{0.5F, 0.5F}}) {
        std::vector<float> said = stage;
        prediction.add_stage(said);
        EXPECT_EQ(said, stage);
    }
}

}  // namespace
}  // namespace exemplar
