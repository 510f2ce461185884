#include "host/hatching/rules/orientation_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/core/random.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/rules/orientation_samples.h"

namespace exemplar {
namespace {

/// Fields that know nothing of each other, one in twenty undefined.
OrientationFields random_fields(std::size_t rows, std::uint64_t seed) {
    Random random(seed);
    OrientationFields fields(rows);
    for (DoubledAngle& v : fields.values)
        v = random.uniform() < 0.05 ? DoubledAngle{} : doubled_angle(static_cast<float>(random.uniform(0, 3.14159)));
    return fields;
}

struct Problem {
    OrientationFields fields;
    std::vector<DoubledAngle> target;
    std::vector<float> weight;
    std::vector<std::uint8_t> held_out;
    /// Directions by a function, turned by noise (a standard deviation in radians); every fourth item is held out.
    Problem(const OrientationFunction& function, double noise, std::uint64_t seed = 1)
        : fields(random_fields(2000, seed)), weight(2000, 1.0f) {
        Random random(seed + 1);
        for (std::size_t i = 0; i < 2000; ++i) {
            const float angle = angle_of(function.evaluate(fields, i));
            target.push_back(doubled_angle(angle + static_cast<float>(noise * random.normal())));
            held_out.push_back(i % 4 == 0);
            // Where the rule says nothing there are no strokes.
            if (function.evaluate(fields, i) == DoubledAngle{}) weight.back() = weight[i] = 0;
        }
    }
    LearnedOrientation learn() const { return learn_orientation({fields, target, weight, held_out}); }
};

/// Degrees between a function and what it was to learn, on average.
double mean_function_error(const OrientationFunction& learned, const OrientationFunction& truth,
                           const OrientationFields& fields) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < fields.rows; ++i) {
        const DoubledAngle expected = truth.evaluate(fields, i), actual = learned.evaluate(fields, i);
        if (expected == DoubledAngle{}) continue;
        sum += 0.5 *
               std::acos(std::clamp(static_cast<double>(expected[0] * actual[0] + expected[1] * actual[1]), -1.0, 1.0));
        count += 1;
    }
    return sum / count * 180 / std::numbers::pi;
}

TEST(DoubledAngle, IsOfDirectionsWithoutSign) {
    for (const float angle : {0.0f, 0.3f, 1.5f, 2.0f, 3.1f}) {
        EXPECT_NEAR(angle_of(doubled_angle(angle)), angle, 1e-6f);
        EXPECT_NEAR(angle_of(doubled_angle(angle + std::numbers::pi_v<float>)), angle, 1e-5f);
        EXPECT_LT(
            squared_distance(doubled_angle(angle + 0.5f * std::numbers::pi_v<float>), -1.0f * doubled_angle(angle)),
            1e-10f);
    }
    EXPECT_EQ(normalized({1e-7f, 0}), DoubledAngle{});
    EXPECT_LT(squared_distance(normalized({0, -4}), {0, -1}), 1e-12f);
}

TEST(OrientationFunction, FeaturesBeyondTheFieldsAreTurned) {
    const OrientationFields fields = random_fields(20, 9);
    const OrientationFunction along{{{4, 1.0f}}}, across{{{feature_of_field(4, true), 1.0f}}}, none{};
    for (std::size_t i = 0; i < 20; ++i) {
        EXPECT_EQ(across.evaluate(fields, i), -1.0f * along.evaluate(fields, i));
        EXPECT_EQ(none.evaluate(fields, i), DoubledAngle{});
    }
}

TEST(LearnedOrientation, FindsTheOneFieldThatIsFollowed) {
    for (const std::uint32_t field : {0u, 17u, 34u}) {
        const OrientationFunction truth{{{field, 1.0f}}};
        const LearnedOrientation learned = Problem(truth, 0.05, field).learn();
        ASSERT_EQ(learned.function.terms.size(), 1U);
        EXPECT_EQ(learned.function.terms[0].feature, field);
        EXPECT_GT(learned.function.terms[0].weight, 0);
        // |u - v|^2 of vectors of doubled angle: (2 noise)^2.
        EXPECT_NEAR(learned.error, 0.01, 0.003);
    }
}

TEST(LearnedOrientation, FindsAFieldTurnedBy90Degrees) {
    const OrientationFunction truth{{{feature_of_field(12, true), 1.0f}}};
    const Problem problem(truth, 0.05);
    const LearnedOrientation learned = problem.learn();
    EXPECT_EQ(learned.function.terms.size(), 1U);
    EXPECT_LT(mean_function_error(learned.function, truth, problem.fields), 0.01);
}

// Weights up to a common factor, within 3%: 1500 items with 3 degrees of noise.
TEST(LearnedOrientation, FindsABlendAndItsWeights) {
    const OrientationFunction truth{{{3, 0.6f}, {20, 0.4f}}};
    const Problem problem(truth, 0.05);
    const LearnedOrientation learned = problem.learn();
    ASSERT_EQ(learned.function.terms.size(), 2U);
    float weights[2] = {};
    for (const auto& term : learned.function.terms) {
        ASSERT_TRUE(term.feature == 3 || term.feature == 20) << term.feature;
        weights[term.feature == 20] = term.weight;
    }
    EXPECT_NEAR(weights[0] / weights[1], 1.5f, 0.045f);
    EXPECT_LT(mean_function_error(learned.function, truth, problem.fields), 1);
}

TEST(LearnedOrientation, FindsABlendOfAFieldAndOneThatIsTurned) {
    const OrientationFunction truth{{{3, 0.7f}, {feature_of_field(20, true), 0.3f}}};
    const Problem problem(truth, 0.03);
    EXPECT_LT(mean_function_error(problem.learn().function, truth, problem.fields), 1);
}

// What is turned by 90 degrees is learned as well, turned.
TEST(LearnedOrientation, TurnsWithItsTarget) {
    const OrientationFunction truth{{{8, 0.5f}, {30, 0.5f}, {31, 0.2f}}};
    Problem problem(truth, 0.1);
    const LearnedOrientation before = problem.learn();
    for (DoubledAngle& u : problem.target) u = -1.0f * u;
    const LearnedOrientation after = problem.learn();
    EXPECT_NEAR(after.error, before.error, 1e-6);
    for (std::size_t i = 0; i < problem.fields.rows; ++i)
        ASSERT_LT(squared_distance(after.function.evaluate(problem.fields, i),
                                   -1.0f * before.function.evaluate(problem.fields, i)),
                  1e-6f);
}

TEST(LearnedOrientation, ItemsWithoutWeightSayNothing) {
    const OrientationFunction truth{{{5, 1.0f}}};
    Problem problem(truth, 0.05);
    for (std::size_t i = 0; i < 2000; ++i) {
        if (i % 5 < 2) continue;
        problem.weight[i] = 0;
        problem.target[i] = problem.fields.feature(11, i);
    }
    const LearnedOrientation learned = problem.learn();
    ASSERT_EQ(learned.function.terms.size(), 1U);
    EXPECT_EQ(learned.function.terms[0].feature, 5U);
}

TEST(LearnedOrientation, OfNothingIsNothing) {
    Problem problem(OrientationFunction{{{5, 1.0f}}}, 0.05);
    const auto no_fields = OrientationFields(2000);
    EXPECT_TRUE(
        learn_orientation({no_fields, problem.target, problem.weight, problem.held_out}).function.terms.empty());
    std::ranges::fill(problem.weight, 0.0f);
    EXPECT_TRUE(problem.learn().function.terms.empty());
}

// Directions that have nothing to do with any field: the error on what is held out is no less than half of the worst
// there is.
TEST(LearnedOrientation, NoiseIsNotLearned) {
    Problem problem(OrientationFunction{{{5, 1.0f}}}, 10.0);
    EXPECT_GT(problem.learn().error, 1.7);
}

struct Places {
    std::vector<std::uint16_t> x, y;
    std::vector<std::uint32_t> group;
};

/// A disk and a band of 200 x 20 pixels, and a few pixels that are a group by themselves.
Places some_places() {
    Places places;
    const auto add = [&](int x, int y, std::uint32_t group) {
        places.x.push_back(static_cast<std::uint16_t>(x));
        places.y.push_back(static_cast<std::uint16_t>(y));
        places.group.push_back(group);
    };
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x)
            if (std::hypot(x - 50, y - 50) < 45) add(x, y, 0);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 200; ++x) add(150 + x, 40 + y, 2);
    for (int x = 0; x < 19; ++x) add(x, 200, 1);
    return places;
}

// A rectangle is at most a fifth of the group wide and high, so that no more than a twenty-fifth (of a disk, whose box
// is larger: a twentieth) is marked beyond the share.
TEST(HeldOutRectangles, MarkTheShareThatIsAskedFor) {
    const Places places = some_places();
    for (const double share : {0.0, 0.1, 0.25, 0.5, 0.9})
        for (std::uint64_t seed = 1; seed <= 10; ++seed) {
            const auto held = held_out_rectangles(places.x, places.y, places.group, share, seed);
            double marked[3] = {}, all[3] = {};
            for (std::size_t i = 0; i < held.size(); ++i) {
                marked[places.group[i]] += held[i];
                all[places.group[i]] += 1;
            }
            for (const std::size_t g : {0u, 2u}) {
                EXPECT_GE(marked[g], share * all[g]);
                EXPECT_LE(marked[g], (share + 0.06) * all[g]) << share;
            }
            EXPECT_EQ(marked[1], 0);
            EXPECT_EQ(held_out_rectangles(places.x, places.y, places.group, share, seed), held);
        }
}

// Held out are regions, so that what is near to what was trained on does not decide.
TEST(HeldOutRectangles, AreRegions) {
    const Places places = some_places();
    const auto held = held_out_rectangles(places.x, places.y, places.group, 0.25, 3);
    EXPECT_NE(held_out_rectangles(places.x, places.y, places.group, 0.25, 4), held);
    std::size_t changes = 0, pairs = 0;
    for (std::size_t i = 1; i < held.size(); ++i) {
        if (places.y[i] != places.y[i - 1] || places.group[i] != places.group[i - 1]) continue;
        ++pairs;
        changes += held[i] != held[i - 1];
    }
    EXPECT_LT(changes, pairs / 10);
}

// Two patches far apart: rectangles may take in each as a whole.
TEST(HeldOutRectangles, LeaveSomethingToLearnFrom) {
    std::vector<std::uint16_t> x, y;
    for (const int patch : {0, 1})
        for (int i = 0; i < (patch ? 320 : 80); ++i) {
            x.push_back(static_cast<std::uint16_t>(900 * patch + i % 20));
            y.push_back(static_cast<std::uint16_t>(900 * patch + i / 20));
        }
    const std::vector<std::uint32_t> group(x.size());
    for (std::uint64_t seed = 1; seed <= 50; ++seed)
        EXPECT_GT(std::ranges::count(held_out_rectangles(x, y, group, 0.25, seed), 0), 0) << seed;
}

TEST(SampleNeighbors, AreThoseWithinTheSpacing) {
    Random random(5);
    OrientationSamples samples;
    for (std::size_t i = 0; i < 600; ++i) {
        samples.x.push_back(static_cast<std::uint16_t>(random.index(90)));
        samples.y.push_back(static_cast<std::uint16_t>(random.index(70)));
        samples.spacing.push_back(static_cast<float>(random.uniform(1, 12)));
    }
    for (const float factor : {0.0f, 0.5f, 1.0f, 3.0f}) {
        const SampleNeighbors neighbors = sample_neighbors(samples, factor);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            std::vector<std::uint32_t> expected, actual(neighbors.of(i).begin(), neighbors.of(i).end());
            for (std::uint32_t j = 0; j < samples.size(); ++j) {
                const double dx = samples.x[j] - samples.x[i], dy = samples.y[j] - samples.y[i];
                const auto radius = static_cast<double>(factor * samples.spacing[i]);
                if (dx * dx + dy * dy <= radius * radius) expected.push_back(j);
            }
            std::ranges::sort(actual);
            ASSERT_EQ(actual, expected) << i;
        }
    }
}

// Features keep their numbers in style files: fields that were added follow the rotated ones of the thesis.
TEST(OrientationFeatures, AreFieldsAndFieldsRotated) {
    EXPECT_EQ(feature_of_field(34), 34U);
    EXPECT_EQ(feature_of_field(0, true), 35U);
    EXPECT_EQ(feature_of_field(35), 70U);
    EXPECT_EQ(feature_of_field(35, true), 73U);
    for (std::uint32_t feature = 0; feature < k_orientation_features; ++feature) {
        EXPECT_EQ(feature_of_field(field_of_feature(feature), is_rotated(feature)), feature);
        const std::string& name = orientation_feature_names()[feature];
        EXPECT_EQ(name.starts_with("perp "), is_rotated(feature)) << name;
    }
    for (std::size_t field = 0; field < k_orientation_fields; ++field)
        EXPECT_EQ("perp " + orientation_feature_names()[feature_of_field(field)],
                  orientation_feature_names()[feature_of_field(field, true)]);
}

}  // namespace
}  // namespace exemplar
