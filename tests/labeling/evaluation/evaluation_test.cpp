#include "host/labeling/evaluation/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>

namespace exemplar {
namespace {

TEST(Evaluation, TheMostProbableLabelsAreThoseOfTheLargestProbabilities) {
    const std::vector<float> probabilities{0.2F, 0.5F, 0.3F, 1, 0, 0, 0.4F, 0.4F, 0.2F};
    EXPECT_EQ(most_probable_labels(probabilities, 3), (std::vector<std::int32_t>{1, 0, 0}))
        << "the first of equal ones";
}

TEST(Evaluation, EntropyIsZeroForOneSureLabelAndOneForEqualOnes) {
    const std::vector<float> entropy = relative_entropy(std::vector<float>{1, 0, 0.5F, 0.5F, 0.25F, 0.75F}, 2);
    ASSERT_EQ(entropy.size(), 3U);
    EXPECT_EQ(entropy[0], 0);
    EXPECT_FLOAT_EQ(entropy[1], 1);
    EXPECT_NEAR(static_cast<double>(entropy[2]), -(0.25 * std::log2(0.25) + 0.75 * std::log2(0.75)), 1e-6);
    EXPECT_EQ(relative_entropy(std::vector<float>{1, 1}, 1), (std::vector<float>{0, 0})) << "one label is always sure";
}

}  // namespace
}  // namespace exemplar
