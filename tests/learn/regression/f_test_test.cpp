#include "host/learn/regression/f_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/core/errors.h"

namespace exemplar {
namespace {

/// The p-value of a statistic F with the given degrees of freedom.
double p_of(double statistic, std::size_t added, std::size_t left) {
    const double full = static_cast<double>(left);  // so that F is the gain over `added`
    return f_test(full + statistic * static_cast<double>(added), 2, full, 2 + added, 2 + added + left).p_value;
}

TEST(FTest, AgreesWithTabulatedCriticalValues) {
    EXPECT_NEAR(p_of(4.9646, 1, 10), 0.05, 1e-5);
    EXPECT_NEAR(p_of(2.7109, 5, 20), 0.05, 1e-5);
    EXPECT_NEAR(p_of(1.9926, 10, 60), 0.05, 1e-5);
    EXPECT_NEAR(p_of(5.6363, 5, 10), 0.01, 1e-5);
    EXPECT_NEAR(p_of(8.0166, 3, 12), 0.00338, 1e-4);
}

TEST(FTest, IsTheStatisticOfTheThesis) {
    // Two joints (J = 2), 40 poses: E_j has 6 parameters, E_FULL 9 J.
    const FTest test = f_test(5.0, 6, 2.0, 18, 40);
    EXPECT_DOUBLE_EQ(test.statistic, ((5.0 - 2.0) / 12) / (2.0 / 22));
    EXPECT_NEAR(f_test(2.0 * 9.0, 1, 2.0, 3, 5).p_value, 1.0 / 9.0, 1e-12);  // F(2, 2): p = 1 / (1 + F), F = 8
}

TEST(FTest, NothingToTellIsAChanceOfOne) {
    EXPECT_EQ(f_test(5, 6, 2, 18, 18).p_value, 1);
    EXPECT_EQ(f_test(5, 6, 2, 18, 4).p_value, 1);
    EXPECT_EQ(f_test(5, 6, 5, 6, 40).p_value, 1);
    EXPECT_EQ(f_test(5, 6, 5, 18, 40).p_value, 1);
    EXPECT_EQ(f_test(4.9999, 6, 5, 18, 40).p_value, 1);  // by rounding
    EXPECT_EQ(f_test(0, 6, 0, 18, 40).p_value, 1);
}

TEST(FTest, ExactFitsAreCertainUnlessBothAreExact) {
    const FTest only_full = f_test(5, 6, 0, 18, 40);
    EXPECT_EQ(only_full.p_value, 0);
    EXPECT_TRUE(std::isinf(only_full.statistic));
    EXPECT_EQ(f_test(5, 6, 1e-27, 18, 40).p_value, 0);
    EXPECT_LT(f_test(3e-28, 6, 1e-29, 18, 40).p_value, 1e-3);
    EXPECT_EQ(f_test(3e-28, 6, 1e-29, 18, 40, 1.0).p_value, 1);  // both are rounding of targets of this size
    EXPECT_EQ(f_test(3e-8, 6, 1e-29, 18, 40, 1.0).p_value, 0);
}

TEST(FTest, RefusesWhatItCannotUse) {
    EXPECT_THROW(f_test(5, 6, -1, 18, 40), UsageError);
    EXPECT_THROW(f_test(std::numeric_limits<double>::quiet_NaN(), 6, 2, 18, 40), UsageError);
    EXPECT_THROW(f_test(5, 18, 2, 6, 40), UsageError);
}

}  // namespace
}  // namespace exemplar
