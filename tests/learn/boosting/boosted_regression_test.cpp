#include "host/learn/boosting/boosted_regression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host/core/random.h"

namespace exemplar {
namespace {

using Errors = std::vector<double>;  // squared errors of a weak learner, per item

/// Bins of width 1/32.
constexpr RegressionBoosting::LineSearch k_search{.max_error = 4, .max_r = 50, .bins = 128};

/// Squared errors at centers of bins, which the histogram does not round.
Errors random_errors(std::size_t count, std::size_t max_bin, std::uint64_t seed) {
    Random random(seed);
    Errors errors(count);
    for (double& e : errors) e = (static_cast<double>(random.index(max_bin)) + 0.5) / 32;
    return errors;
}

RegressionBoosting::Step search_r(const RegressionBoosting& boosting, const Errors& errors) {
    return boosting.line_search([&](std::size_t i) { return errors[i]; }, k_search);
}

void add_learner(RegressionBoosting& boosting, const Errors& errors, double r) {
    boosting.add([&](std::size_t i) { return r * errors[i]; });
}

/// Eq. 2.71, divided by the number of items.
double whole_objective(const std::vector<Errors>& learners, const std::vector<double>& r) {
    double sum = 0;
    for (std::size_t i = 0; i < learners[0].size(); ++i) {
        double product = 1, exponent = 0;
        for (std::size_t m = 0; m < learners.size(); ++m) {
            product /= std::sqrt(r[m]);
            exponent += r[m] * learners[m][i];
        }
        sum += product * std::exp(exponent) / static_cast<double>(learners[0].size());
    }
    return sum;
}

TEST(RegressionBoosting, ObjectivesOfRoundsMultiplyToThatOfAllWeakLearners) {
    std::vector<Errors> learners;
    for (std::uint64_t m = 0; m < 4; ++m) learners.push_back(random_errors(50, 20, m + 1));
    RegressionBoosting boosting(std::vector<double>(50, 3.0));
    std::vector<double> r;
    double product = 1;
    for (const Errors& errors : learners) {
        const RegressionBoosting::Step step = search_r(boosting, errors);
        product *= step.objective;
        r.push_back(step.r);
        add_learner(boosting, errors, step.r);
    }
    EXPECT_EQ(r[0], 1);
    EXPECT_NEAR(product, whole_objective(learners, r), 1e-12 * product);
}

// Each coefficient minimizes Eq. 2.71 given those before it.
TEST(RegressionBoosting, LineSearchMinimizesTheObjective) {
    const std::vector<Errors> learners{random_errors(50, 20, 1), random_errors(50, 20, 2)};
    RegressionBoosting boosting(std::vector<double>(50, 1.0));
    add_learner(boosting, learners[0], 1);
    const double r = search_r(boosting, learners[1]).r;
    const double least = whole_objective(learners, {1, r});
    for (const double factor : {0.5, 0.9, 0.99, 1.01, 1.1, 2.0})
        EXPECT_GT(whole_objective(learners, {1, factor * r}), least) << factor;
}

// r^-1/2 exp(r e) has its minimum at r = 1 / (2 e).
TEST(RegressionBoosting, CoefficientOfAConstantErrorIsKnown) {
    for (const double e : {0.5 / 32, 10.5 / 32, 100.5 / 32}) {
        RegressionBoosting boosting({1, 1, 1});
        const Errors errors(3, e);
        add_learner(boosting, errors, search_r(boosting, errors).r);
        const RegressionBoosting::Step step = search_r(boosting, errors);
        EXPECT_NEAR(step.r, 0.5 / e, 1e-3 / e);
        EXPECT_NEAR(step.objective, std::sqrt(2 * e) * std::exp(0.5), 1e-6);
    }
    RegressionBoosting exact({1, 1});
    add_learner(exact, {0, 0}, 1);
    EXPECT_NEAR(search_r(exact, {0, 0}).r, 32, 0.1) << "zero counts as half a bin";
}

TEST(RegressionBoosting, WeightsGrowWithTheErrorsOfWhatWasAdded) {
    const Errors first{0, 1, 2, 1}, second{1, 0, 0.5, 1};
    RegressionBoosting boosting({1, 1, 1, 0});
    add_learner(boosting, first, 1);
    add_learner(boosting, second, 0.7);
    double total = 0;
    for (std::size_t i = 0; i < 3; ++i) total += std::exp(first[i] + 0.7 * second[i]);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(boosting.weights()[i], std::exp(first[i] + 0.7 * second[i]) / total, 1e-15);
    EXPECT_EQ(boosting.weights()[3], 0) << "held out";
}

// Once a learner is added, its errors count more than those of the others.
TEST(RegressionBoosting, PicksTheLearnerThatIsRightWhereTheFirstIsWrong) {
    const std::vector<Errors> learners{{0, 0, 2, 2}, {0.1, 0.1, 2, 2}, {1.5, 1.5, 0, 0}};
    RegressionBoosting boosting(std::vector<double>(4, 1.0));
    const auto pick = [&] {
        const auto objective_of = [&](const Errors& errors) { return search_r(boosting, errors).objective; };
        const auto best = std::ranges::min_element(learners, {}, objective_of);
        add_learner(boosting, *best, search_r(boosting, *best).r);
        return best - learners.begin();
    };
    EXPECT_EQ(pick(), 2);
    EXPECT_EQ(pick(), 0);
}

TEST(RegressionBoosting, WithoutWeightThereIsNothingToLearn) {
    RegressionBoosting boosting({0, 0});
    add_learner(boosting, {1, 2}, 1);
    for (const double w : boosting.weights()) EXPECT_EQ(w, 0);
}

TEST(NormalizeCoefficients, MakesAWeightedMean) {
    struct Term {
        float r;
    };
    std::vector<Term> terms{{1}, {2}, {5}};
    normalize_coefficients(terms, &Term::r);
    EXPECT_EQ(terms[0].r, 0.125f);
    EXPECT_EQ(terms[1].r, 0.25f);
    EXPECT_EQ(terms[2].r, 0.625f);
}

TEST(HeldOutError, IsOfAllItemsIfNoneIsHeldOut) {
    HeldOutError error;
    EXPECT_EQ(error.mean(7), 7);
    error.add(false, 1, 2);
    error.add(false, 3, 6);
    EXPECT_EQ(error.mean(7), 5);
    error.add(true, 0.5, 10);
    EXPECT_EQ(error.mean(7), 10);
}

}  // namespace
}  // namespace exemplar
