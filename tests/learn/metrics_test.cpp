#include "host/learn/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "host/core/errors.h"
#include "host/core/random.h"

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

TEST(Metrics, RandIndexEqualsCountingPairs) {
    Random random(1);
    for (int trial = 0; trial < 20; ++trial) {
        const std::size_t count = 2 + random.index(40);
        std::vector<std::int32_t> a(count), b(count);
        for (std::size_t i = 0; i < count; ++i) {
            a[i] = static_cast<std::int32_t>(random.index(4)) * 1000 - 7;  // ids are arbitrary
            b[i] = static_cast<std::int32_t>(random.index(5));
        }
        double differ = 0.0, all = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < i; ++j) {
                differ += (a[i] == a[j]) != (b[i] == b[j]) ? 1.0 : 0.0;
                all += 1.0;
            }
        }
        EXPECT_NEAR(rand_index_error(a, b), differ / all, 1e-12);
        EXPECT_EQ(rand_index_error(a, a), 0.0);
        EXPECT_DOUBLE_EQ(rand_index_error(a, b), rand_index_error(b, a));
    }
    EXPECT_EQ(rand_index_error(std::vector<std::int32_t>{3}, std::vector<std::int32_t>{4}), 0.0);
    EXPECT_EQ(rand_index_error(std::vector<std::int32_t>{0, 0}, std::vector<std::int32_t>{0, 1}), 1.0);
}

TEST(Metrics, RefuseSizesAndLabelsThatDoNotFit) {
    const std::vector<std::int32_t> bad{0, 0, 1, 1, 9, 0};
    EXPECT_THROW(confusion_matrix(bad, k_predicted, k_areas, 4), UsageError);
    EXPECT_THROW(confusion_matrix(k_truth, {}, k_areas, 4), UsageError);
    EXPECT_THROW(confusion_matrix(k_truth, k_predicted, {}, 4), UsageError);
    EXPECT_THROW(rand_index_error(k_truth, {}), UsageError);
}

}  // namespace
}  // namespace exemplar
