#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <vector>

#include "gpu/hatching/hatching_evaluator.h"
#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/style/style_prediction.h"
#include "tests/gpu/support/environment.h"

// Rules: sums of up to 8 products round by some 2^-22 of their magnitudes, over the length of the sum. Properties:
// Vulkan allows logarithms to be off by 2^-21 near 1, else by 3 in the last place, and exponentials by (3 + 2 |x|)
// 2^-23; what is in a logarithm is known to the rounding of a x and b, over their sum.
namespace exemplar {
namespace {

using test_support::shared_device;

const std::initializer_list<std::size_t> k_odd_sizes{0, 1, 3, 4, 5, 63, 64, 65, 255, 256, 257, 1003};

OrientationFields random_fields(std::size_t rows, Random& random) {
    OrientationFields fields(rows);
    for (DoubledAngle& v : fields.values)
        v = random.uniform() < 0.1 ? DoubledAngle{} : doubled_angle(static_cast<float>(random.uniform(0, 3.2)));
    return fields;
}

std::vector<OrientationFunction> random_functions(std::size_t count, Random& random) {
    std::vector<OrientationFunction> functions(count);
    for (OrientationFunction& function : functions)
        for (std::size_t terms = random.index(9); terms > 0; --terms)
            function.terms.push_back({static_cast<std::uint32_t>(random.index(k_orientation_features)),
                                      static_cast<float>(random.normal())});
    return functions;
}

std::vector<std::int32_t> random_segments(std::size_t rows, std::size_t count, Random& random) {
    std::vector<std::int32_t> segments(rows);
    for (std::int32_t& s : segments) s = static_cast<std::int32_t>(random.index(count));
    return segments;
}

/// How long the sum of a function is, and of how much it is made.
std::array<double, 2> length_and_size(const OrientationFunction& function, const OrientationFields& fields,
                                      std::size_t i) {
    double x = 0, y = 0, size = 0;
    for (const auto& term : function.terms) {
        const DoubledAngle v = fields.feature(term.feature, i);
        x += static_cast<double>(term.weight * v[0]);
        y += static_cast<double>(term.weight * v[1]);
        size += static_cast<double>(std::abs(term.weight) * std::hypot(v[0], v[1]));
    }
    return {std::hypot(x, y), size};
}

void expect_orientation_parity(HatchingEvaluator& device, std::size_t rows, std::size_t segments, Random& random) {
    const OrientationFields fields = random_fields(rows, random);
    const std::vector<OrientationFunction> functions = random_functions(segments, random);
    const std::vector<std::int32_t> segment = random_segments(rows, segments, random);
    const auto expected = CpuHatchingEvaluator().orientations(functions, segment, fields);
    const auto actual = device.orientations(functions, segment, fields);
    ASSERT_EQ(actual.size(), rows);
    std::size_t unknown = 0;
    for (std::size_t i = 0; i < rows; ++i) {
        const auto [length, size] = length_and_size(functions[static_cast<std::size_t>(segment[i])], fields, i);
        if (size == 0) {
            ASSERT_EQ(actual[i], DoubledAngle{}) << i;
        } else if (length < 1e-4 * size + 2e-6) {
            ++unknown;  // no direction, or any
        } else {
            const double apart = std::sqrt(static_cast<double>(squared_distance(actual[i], expected[i])));
            ASSERT_LT(apart, 1e-6 + 0x1p-21 * size / length) << i;
        }
    }
    EXPECT_LE(unknown, 2 + rows / 100);
}

TEST(HatchingEvaluatorParity, OrientationsOfOddNumbersOfRowsAndSegments) {
    GpuHatchingEvaluator evaluator(shared_device());
    Random random(1);
    for (const std::size_t rows : k_odd_sizes)
        for (const std::size_t segments : {1u, 2u, 5u, 64u}) {
            SCOPED_TRACE(::testing::Message() << rows << " rows, " << segments << " segments");
            expect_orientation_parity(evaluator, rows, segments, random);
        }
}

TEST(HatchingEvaluatorParity, RowsAreTiledToTheLimit) {
    Random random(2);
    for (const std::size_t tile_bytes : {1u, 5000u, 40'000u}) {
        SCOPED_TRACE(tile_bytes);
        GpuHatchingEvaluator evaluator(shared_device(), nullptr, tile_bytes);
        expect_orientation_parity(evaluator, 1001, 7, random);
    }
}

// Turned by 90 degrees, a field is the same with the other sign.
TEST(HatchingEvaluatorParity, TurnedFieldsAreTheOthersNegated) {
    GpuHatchingEvaluator gpu(shared_device());
    Random random(3);
    const OrientationFields fields = random_fields(50, random);
    const std::vector<OrientationFunction> functions{
        {{{7, 0.5f}, {feature_of_field(36, true), 0.25f}}},
        {{{feature_of_field(7, true), -0.5f}, {feature_of_field(36), -0.25f}}}};
    const std::vector<std::int32_t> zeros(50, 0), ones(50, 1);
    EXPECT_EQ(gpu.orientations(functions, zeros, fields), gpu.orientations(functions, ones, fields));
}

/// Base features of both signs over six orders, with zeros and what is no number.
FeatureMatrix random_features(std::size_t rows, std::size_t columns, Random& random) {
    FeatureMatrix features;
    features.rows = rows;
    for (std::size_t c = 0; c < columns; ++c) {
        const double size = std::pow(10, random.uniform(-3, 3));
        for (float& value : features.add("test")) {
            value = static_cast<float>(size * random.normal());
            if (random.uniform() < 0.02) value = 0;
            if (random.uniform() < 0.01) value = std::numeric_limits<float>::quiet_NaN();
            if (random.uniform() < 0.01) value = std::numeric_limits<float>::infinity();
            if (random.uniform() < 0.01) value = -std::numeric_limits<float>::infinity();
            if (random.uniform() < 0.01) value = 3e38f;
        }
    }
    return features;
}

/// Over the middle half of the values of each feature, where a x + b stays positive or touches its least value.
PropertyModel random_model(std::size_t terms, std::span<const std::uint32_t> which, const FeatureMatrix& features,
                           Random& random) {
    PropertyModel model;
    model.factor = static_cast<float>(std::exp(random.uniform(-2, 2)));
    for (std::size_t k = 0; k < terms; ++k) {
        const std::size_t column = random.index(which.size()), power = random.index(k_powers);
        std::vector<float> values;
        for (const float x : features.column(column))
            if (std::isfinite(power_of(x, power))) values.push_back(power_of(x, power));
        if (values.empty()) values = {0.0f};
        std::ranges::sort(values);
        PropertyModel::Term term;
        term.feature = static_cast<std::uint32_t>(which[column] * k_powers + power);
        term.low = values[values.size() / 4];
        term.high = values[values.size() - 1 - values.size() / 4];
        const float extent = std::max(term.high - term.low, 1e-6f);
        term.a = static_cast<float>(random.uniform(-2, 2)) / extent;
        term.b = static_cast<float>(random.uniform(0, 3)) - term.a * term.low;
        term.least = 0.05f;
        term.exponent = static_cast<float>(random.uniform(-1, 1));
        model.terms.push_back(term);
    }
    return model;
}

double relative_tolerance(const PropertyModel& model, std::span<const std::uint32_t> which,
                          const FeatureMatrix& features, std::size_t row) {
    double tolerance = 1e-6, sum = std::abs(std::log(static_cast<double>(model.factor)));
    for (const PropertyModel::Term& term : model.terms) {
        const auto column = static_cast<std::size_t>(std::ranges::find(which, term.feature / k_powers) - which.begin());
        float x = power_of(features.column(column)[row], term.feature % k_powers);
        x = x > term.low ? std::min(x, term.high) : term.low;
        const auto inside = static_cast<double>(std::max(term.a * x + term.b, term.least));
        const double size = static_cast<double>(std::abs(term.a * x) + std::abs(term.b)) / inside;
        const auto exponent = static_cast<double>(std::abs(term.exponent));
        // The power of x rounds thrice, its product with a, and the sum.
        tolerance += exponent * (0x1p-21 + 6 * 0x1p-24 * size + 4 * 0x1p-24 * std::abs(std::log(inside)));
        sum += exponent * std::abs(std::log(inside));
    }
    return tolerance + 8 * 0x1p-24 * (1 + sum) * (1 + 0.1 * static_cast<double>(model.terms.size()));
}

void expect_property_parity(HatchingEvaluator& device, std::size_t rows, std::size_t terms, Random& random) {
    const std::vector<std::uint32_t> which{4, 8, 300, 1, 77, 12, 13};
    const FeatureMatrix features = random_features(rows, which.size(), random);
    const PropertyModel model = random_model(terms, which, features, random);
    const std::vector<float> expected = CpuHatchingEvaluator().property(model, which, features);
    const std::vector<float> actual = device.property(model, which, features);
    ASSERT_EQ(actual.size(), rows);
    for (std::size_t i = 0; i < rows; ++i) {
        ASSERT_TRUE(std::isfinite(expected[i]) && expected[i] > 0) << i;
        ASSERT_NEAR(actual[i] / expected[i], 1, relative_tolerance(model, which, features, i)) << "row " << i;
    }
}

TEST(HatchingEvaluatorParity, PropertiesOfOddNumbersOfRows) {
    GpuHatchingEvaluator evaluator(shared_device());
    Random random(4);
    for (const std::size_t rows : k_odd_sizes) {
        SCOPED_TRACE(rows);
        expect_property_parity(evaluator, rows, 5, random);
    }
}

TEST(HatchingEvaluatorParity, PropertiesOfAnyNumberOfTerms) {
    Random random(5);
    for (const std::size_t tile_bytes : {1u, 3000u, 100'000'000u}) {
        GpuHatchingEvaluator evaluator(shared_device(), nullptr, tile_bytes);
        for (const std::size_t terms : {0u, 1u, 2u, 24u}) {
            SCOPED_TRACE(::testing::Message() << terms << " terms, " << tile_bytes);
            expect_property_parity(evaluator, 517, terms, random);
        }
    }
}

TEST(HatchingEvaluatorParity, InputsOnTheDevice) {
    Device& device = shared_device();
    GpuHatchingEvaluator evaluator(device);
    Random random(31);
    constexpr std::size_t k_rows = 301, k_stride = 320;
    const OrientationFields fields = random_fields(k_rows, random);
    const std::vector<OrientationFunction> functions = random_functions(4, random);
    const std::vector<std::int32_t> segment = random_segments(k_rows, 4, random);
    const std::vector<std::uint32_t> used = GpuHatchingEvaluator::fields_of(functions);
    Buffer inputs(device, used.size() * k_stride * sizeof(DoubledAngle)), out(device, k_rows * sizeof(DoubledAngle));
    for (std::size_t k = 0; k < used.size(); ++k)
        inputs.upload(fields.field(used[k]), k * k_stride * sizeof(DoubledAngle));
    const Buffer segments = Buffer::of<std::int32_t>(device, segment);
    std::vector<DoubledAngle> directions(k_rows);
    Stream stream(device);
    evaluator.record_orientations(stream, functions, segments, inputs, k_rows, k_stride, out);
    stream.fetch<DoubledAngle>(out, directions);
    EXPECT_EQ(directions, evaluator.orientations(functions, segment, fields));
    EXPECT_THROW(evaluator.record_orientations(stream, functions, segments, inputs, k_rows, k_rows - 1, out),
                 UsageError);
    EXPECT_THROW(evaluator.record_orientations(stream, functions, segments, inputs, k_rows, 2 * k_stride, out),
                 UsageError);

    const std::vector<std::uint32_t> which{4, 8, 300, 1, 77, 12, 13};
    const FeatureMatrix base = random_features(k_rows, which.size(), random);
    const PropertyModel model = random_model(12, which, base, random);
    const std::vector<std::uint32_t> features = GpuHatchingEvaluator::features_of(model);
    Buffer columns(device, features.size() * k_stride * sizeof(float)), result(device, k_stride * sizeof(float));
    for (std::size_t k = 0; k < features.size(); ++k) {
        const auto place = static_cast<std::size_t>(std::ranges::find(which, features[k]) - which.begin());
        std::vector<float> values(base.column(place).begin(), base.column(place).end());
        for (float& value : values) value = std::isnan(value) ? -2e30F : std::clamp(value, -1e19F, 1e19F);
        columns.upload<float>(values, k * k_stride * sizeof(float));
    }
    std::vector<float> values(k_rows);
    evaluator.record_property(stream, model, columns, k_rows, k_stride, result);
    const HostReadback part{0, std::as_writable_bytes(std::span(values))};
    stream.fetch(result, std::span(&part, 1));
    EXPECT_EQ(values, evaluator.property(model, which, base));
    EXPECT_THROW(evaluator.record_property(stream, model, columns, k_rows, 302, result), UsageError);
    EXPECT_THROW(evaluator.record_property(stream, model, columns, k_rows, 324, result), UsageError);
}

TEST(HatchingEvaluatorParity, IsDeterministic) {
    GpuHatchingEvaluator evaluator(shared_device());
    Random random(6);
    const std::vector<std::uint32_t> which{3, 5};
    const FeatureMatrix features = random_features(700, 2, random);
    const PropertyModel model = random_model(6, which, features, random);
    const OrientationFields fields = random_fields(700, random);
    const auto functions = random_functions(4, random);
    const auto segments = random_segments(700, 4, random);
    const auto values = evaluator.property(model, which, features);
    const auto directions = evaluator.orientations(functions, segments, fields);
    evaluator.property(random_model(3, which, features, random), which, features);
    EXPECT_EQ(evaluator.property(model, which, features), values);
    EXPECT_EQ(evaluator.orientations(functions, segments, fields), directions);
}

TEST(HatchingEvaluatorParity, RefusesWhatTheReferenceRefuses) {
    GpuHatchingEvaluator gpu(shared_device());
    CpuHatchingEvaluator cpu;
    Random random(7);
    const OrientationFields fields = random_fields(3, random);
    const std::vector<OrientationFunction> functions(2), beyond{{{{k_orientation_features, 1.0f}}}};
    const FeatureMatrix features = random_features(3, 1, random);
    PropertyModel model;
    model.terms.push_back({.feature = 4 * 6, .a = 1, .b = 1, .exponent = 1, .low = 0, .high = 1, .least = 0.1f});
    const std::vector<std::int32_t> zeros(3, 0), two{0, 2, 0}, negative{0, -1, 0}, few(2, 0);
    const std::vector<std::uint32_t> seven{7};
    for (HatchingEvaluator* evaluator : std::initializer_list<HatchingEvaluator*>{&gpu, &cpu}) {
        EXPECT_THROW(evaluator->orientations(functions, two, fields), UsageError);
        EXPECT_THROW(evaluator->orientations(functions, negative, fields), UsageError);
        EXPECT_THROW(evaluator->orientations(functions, few, fields), UsageError);
        EXPECT_THROW(evaluator->orientations(beyond, zeros, fields), UsageError);
        EXPECT_THROW(evaluator->property(model, seven, features), UsageError);
    }
}

}  // namespace
}  // namespace exemplar
