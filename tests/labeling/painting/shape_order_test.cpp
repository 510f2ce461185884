#include "host/labeling/painting/shape_order.h"

#include <gtest/gtest.h>

#include "host/core/errors.h"

namespace exemplar {
namespace {

std::vector<ShapeDescriptor> on_a_line(const std::vector<float>& places) {
    std::vector<ShapeDescriptor> shapes;
    shapes.reserve(places.size());
    for (const float place : places) shapes.push_back({{"x"}, {place, 1, 1}});
    return shapes;
}

TEST(ShapeOrder, LikenessFallsWithDistanceWhateverTheUnit) {
    const ShapeLikeness likeness(on_a_line({0, 1, 2, 10})), scaled(on_a_line({0, 1000, 2000, 10000}));
    EXPECT_FLOAT_EQ(likeness(0, 0), 1);
    EXPECT_EQ(likeness(0, 1), likeness(1, 0));
    EXPECT_GT(likeness(0, 1), likeness(0, 2));
    EXPECT_GT(likeness(0, 2), likeness(0, 3));
    EXPECT_NEAR(likeness(0, 1), scaled(0, 1), 1e-4F);
    EXPECT_THROW(ShapeLikeness(std::vector<ShapeDescriptor>{{{"x"}, {1}}, {{"x"}, {1, 2}}}), UsageError);
}

TEST(ShapeOrder, TheMiddleOfALargeGroupComesFirstThenAnotherGroup) {
    // A group of five around 0, one of three around 100.
    const ShapeLikeness likeness(on_a_line({-2, -1, 0, 1, 2, 99, 100, 101}));
    const std::vector<std::size_t> order = order_by_gain(likeness, std::vector<float>(8, 1), 3);
    ASSERT_EQ(order.size(), 8u);
    EXPECT_EQ(order[0], 2u);
    EXPECT_GE(order[1], 5u);
}

TEST(ShapeOrder, LabeledShapesAreLeftOutAndUncertainOnesComeFirst) {
    const ShapeLikeness likeness(on_a_line({0, 100, 200, 300}));
    const std::vector<float> uncertainty{0, 0.2F, 0.9F, 0.5F};
    EXPECT_EQ(order_by_gain(likeness, uncertainty, 0), (std::vector<std::size_t>{2, 3, 1})) << "strokes cost nothing";
    EXPECT_TRUE(order_by_gain(likeness, std::vector<float>(4, 0), 3).empty());
    EXPECT_THROW(order_by_gain(likeness, std::vector<float>(3, 0), 3), UsageError);
}

TEST(ShapeOrder, APersonsSecondsCount) {
    EXPECT_DOUBLE_EQ(expected_seconds(0, 5), 6.5);
    EXPECT_DOUBLE_EQ(expected_seconds(0.5F, 5, {.open = 10, .stroke = 2, .verify = 1, .face = 1}), 21);
    // All gain the same; the first takes most strokes.
    const ShapeLikeness likeness(on_a_line({5, 5, 5}));
    const std::vector<float> uncertainty{0.9F, 0.2F, 0.4F};
    EXPECT_EQ(order_by_gain(likeness, uncertainty, 3).front(), 1u);
    const PersonCosts without_strokes{.open = 5, .stroke = 0, .verify = 1.5, .face = 1};
    EXPECT_EQ(order_by_gain(likeness, uncertainty, 3, without_strokes).front(), 0u);
}

TEST(ShapeOrder, ShapesThatAreAllAlikeComeInTheirOrder) {
    const ShapeLikeness likeness(on_a_line({5, 5, 5}));
    EXPECT_EQ(order_by_gain(likeness, std::vector<float>(3, 1), 3), (std::vector<std::size_t>{0, 1, 2}));
}

}  // namespace
}  // namespace exemplar
