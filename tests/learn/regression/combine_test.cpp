#include "host/learn/regression/combine.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "host/core/errors.h"

namespace exemplar {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(PredictorWeights, AreTheShareOfTheOthersResiduals) {
    // (2 + 5) / (2 * 8), (1 + 5) / (2 * 8), (1 + 2) / (2 * 8)
    EXPECT_THAT(predictor_weights(std::vector<double>{1, 2, 5}),
                ElementsAre(DoubleNear(7.0 / 16, 1e-15), DoubleNear(6.0 / 16, 1e-15), DoubleNear(3.0 / 16, 1e-15)));
    EXPECT_THAT(predictor_weights(std::vector<double>{3, 1}), ElementsAre(0.25, 0.75));
}

TEST(PredictorWeights, AnExactPredictorOfTwoTakesAll) {
    EXPECT_THAT(predictor_weights(std::vector<double>{0, 4}), ElementsAre(1, 0));
}

TEST(PredictorWeights, OneIsAloneAndExactOnesShare) {
    EXPECT_THAT(predictor_weights({}), IsEmpty());
    EXPECT_THAT(predictor_weights(std::vector<double>{7}), ElementsAre(1));
    EXPECT_THAT(predictor_weights(std::vector<double>{0}), ElementsAre(1));
    EXPECT_THAT(predictor_weights(std::vector<double>{0, 0, 0, 0}), ElementsAre(0.25, 0.25, 0.25, 0.25));
}

TEST(PredictorWeights, HoldForResidualsOfAnySize) {
    EXPECT_THAT(predictor_weights(std::vector<double>{3e-320, 1e-320}),
                ElementsAre(DoubleNear(0.25, 1e-3), DoubleNear(0.75, 1e-3)));
    EXPECT_THAT(predictor_weights(std::vector<double>{1.5e308, 0.5e308}),
                ElementsAre(DoubleNear(0.25, 1e-12), DoubleNear(0.75, 1e-12)));
}

TEST(PredictorWeights, RefuseWhatIsNoSumOfSquares) {
    EXPECT_THROW(predictor_weights(std::vector<double>{1, -1}), UsageError);
    EXPECT_THROW(predictor_weights(std::vector<double>{std::numeric_limits<double>::infinity(), 1}), UsageError);
    EXPECT_THROW(predictor_weights(std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}), UsageError);
}

}  // namespace
}  // namespace exemplar
