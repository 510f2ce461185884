#include "host/learn/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/core/errors.h"

namespace exemplar {
namespace {

const std::vector<std::int32_t> k_truth{0, 0, 1, 1, 2, -1};
const std::vector<std::int32_t> k_predicted{0, 1, 1, 1, 7, 0};
const std::vector<float> k_areas{1, 3, 2, 2, 2, 50};

TEST(Metrics, ConfusionIsWeightedByArea) {
    const ConfusionMatrix confusion = confusion_matrix(k_truth, k_predicted, k_areas, 4);
    EXPECT_EQ(confusion.at(0, 0), 1.0);
    EXPECT_EQ(confusion.at(0, 1), 3.0);
    EXPECT_EQ(confusion.at(1, 1), 4.0);
    EXPECT_EQ(confusion.at(2, 4), 2.0);  // a label that does not exist
    EXPECT_EQ(confusion.counts, (std::vector<std::size_t>{2, 2, 1, 0}));
    EXPECT_DOUBLE_EQ(recognition_rate(confusion), 0.5);
    EXPECT_DOUBLE_EQ(segment_weighted_accuracy(confusion), (0.25 + 1.0 + 0.0) / 3.0);  // class 3 does not occur
}

TEST(Metrics, AClassWithoutAreaCountsAsPresentAndWrong) {
    const std::vector<std::int32_t> labels{0, 1};
    const std::vector<float> areas{2.0f, 0.0f};
    const ConfusionMatrix confusion = confusion_matrix(labels, labels, areas, 2);
    EXPECT_DOUBLE_EQ(segment_weighted_accuracy(confusion), 0.5);
    EXPECT_DOUBLE_EQ(recognition_rate(confusion), 1.0);
}

TEST(Metrics, NothingToMeasureIsNan) {
    const ConfusionMatrix empty = confusion_matrix({}, {}, {}, 3);
    EXPECT_TRUE(std::isnan(recognition_rate(empty)));
    EXPECT_TRUE(std::isnan(segment_weighted_accuracy(empty)));
}

TEST(Metrics, RefuseSizesAndLabelsThatDoNotFit) {
    const std::vector<std::int32_t> bad{0, 0, 1, 1, 9, 0};
    EXPECT_THROW(confusion_matrix(bad, k_predicted, k_areas, 4), UsageError);
    EXPECT_THROW(confusion_matrix(k_truth, {}, k_areas, 4), UsageError);
    EXPECT_THROW(confusion_matrix(k_truth, k_predicted, {}, 4), UsageError);
}

}  // namespace
}  // namespace exemplar
