#include "host/data/catalog/run_summary.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "host/data/catalog/catalog_run.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class RunSummaryTest : public testing::Test {
  protected:
    /// A shape with a result, in the order of the calls numbered from 1.
    ShapeRecord record(const std::string& category, double confidence, nlohmann::json labels) {
        ShapeRecord record;
        record.model = record.category = category;
        record.confidence = confidence;
        record.labels = std::move(labels);
        record.seconds = {{"read", 0.5}, {"cut", 0.25}};
        record.finished = 1000 + static_cast<double>(count_);
        return record;
    }
    void add(ShapeRecord record, std::int64_t faces = 100) {
        CatalogShape shape;
        shape.path = fmt::format("/shapes/{}.off", ++count_);
        shape.name = std::to_string(count_);
        shape.hash = std::to_string(count_);
        shape.faces = faces;
        catalog_.put(std::span(&shape, 1));
        record.content = shape.hash;
        run_.finish(count_, record);
    }
    void add_cups(int count) {
        for (int i = 0; i < count; ++i) add(record("cup", 0.01 * ((i * 7) % count), {}));
    }
    TemporaryFolder folder_;
    Catalog catalog_{folder_ / "shapes.db", Database::Open::create};
    CatalogRun run_{catalog_, "key", folder_.path(), "models"};
    std::int64_t count_ = 0;
};

TEST_F(RunSummaryTest, CountsByCategory) {
    add(record("cup", 0.5, {}));
    add(record("cup", 1, {}));
    add(record("chair", 0.25, {}));
    ShapeRecord recognized = record("cup", 0.75, {});
    recognized.category_probability = 0.9;
    add(recognized);
    ShapeRecord failed = record("cup", std::nan(""), {});
    failed.error = "why";
    add(failed);
    ShapeRecord unknown = record(std::string(k_unknown_category), std::nan(""), {});
    unknown.error = "of no category";
    unknown.model.clear();
    add(unknown);
    const std::vector<CategorySummary> all = summarize_categories(catalog_, run_.id(), 10);
    ASSERT_EQ(all.size(), 3U);
    EXPECT_EQ(all[0].category, "cup");
    EXPECT_EQ(all[0].model, "cup");
    EXPECT_EQ(all[0].done, 3);
    EXPECT_EQ(all[0].failed, 1);
    EXPECT_EQ(all[0].recognized, 1);
    EXPECT_DOUBLE_EQ(all[0].confidence, 0.75);
    EXPECT_EQ(all[1].category, "chair");
    EXPECT_EQ(all[2].unknown, 1);
    EXPECT_TRUE(std::isnan(all[2].confidence));
    EXPECT_EQ(summarize_categories(catalog_, run_.id(), 2).size(), 2U);
    EXPECT_THAT(summarize_categories(catalog_, run_.id() + 1, 10), IsEmpty());
    const RunTotals totals = summarize_run(catalog_, run_.id());
    EXPECT_DOUBLE_EQ(totals.confidence, 2.5 / 4);
    EXPECT_DOUBLE_EQ(totals.last_finished, 1005);
}

TEST_F(RunSummaryTest, AreaIsTheMeanOverAllShapesOfTheCategory) {
    using nlohmann::json;  // json{one} is a list of one to GCC and a copy of the one to Clang
    const auto part = [](const char* name, double area, double confidence) {
        return json{{"label", name}, {"area_share", area}, {"confidence", confidence}};
    };
    add(record("cup", 1, json::array({part("body", 0.75, 0.5), part("handle", 0.25, 1)})));
    add(record("cup", 1, json::array({part("body", 1, 1)})));
    add(record("chair", 1, json::array({part("seat", 1, 1)})));
    const std::vector<LabelSummary> labels = summarize_labels(catalog_, run_.id(), "cup", 10);
    ASSERT_EQ(labels.size(), 2U);
    EXPECT_EQ(labels[0].label, "body");
    EXPECT_EQ(labels[0].shapes, 2);
    EXPECT_DOUBLE_EQ(labels[0].area, 0.875);
    EXPECT_DOUBLE_EQ(labels[0].confidence, 0.75);
    EXPECT_EQ(labels[1].label, "handle");
    EXPECT_EQ(labels[1].shapes, 1);
    EXPECT_DOUBLE_EQ(labels[1].area, 0.125);
    EXPECT_EQ(summarize_labels(catalog_, run_.id(), "cup", 1).size(), 1U);
}

TEST_F(RunSummaryTest, StrangeRowsCostNothing) {
    add(record("cup", 1, nlohmann::json::array({{{"label", "body"}, {"area_share", 1}, {"confidence", 1}}})));
    add(record("cup", 1, {1, "two", {{"no", "label"}}}));
    catalog_.database().execute("UPDATE labels SET labels = '[{\"label\"', seconds = 'x' WHERE shape = 2");
    const std::vector<LabelSummary> labels = summarize_labels(catalog_, run_.id(), "cup", 10);
    ASSERT_EQ(labels.size(), 1U);
    EXPECT_DOUBLE_EQ(labels[0].area, 0.5);
    EXPECT_EQ(summarize_stages(catalog_, run_.id()).size(), 2U);
}

TEST_F(RunSummaryTest, StagesAddUp) {
    add_cups(4);
    const std::vector<StageSummary> stages = summarize_stages(catalog_, run_.id());
    ASSERT_EQ(stages.size(), 2U);
    EXPECT_EQ(stages[0].stage, "read");
    EXPECT_EQ(stages[0].shapes, 4);
    EXPECT_DOUBLE_EQ(stages[0].seconds, 2);
    EXPECT_EQ(stages[1].stage, "cut");
}

TEST_F(RunSummaryTest, ExamplesAreTheLeastSureAndOthersUpToTheSurest) {
    for (int i = 0; i < 13; ++i) add(record("cup", 0.05 * i, {}));  // shape k has rank k
    add(record("chair", 0, {}));
    EXPECT_THAT(example_shapes(catalog_, run_.id(), "cup", 3, 3, 1000), ElementsAre(1, 2, 3, 6, 9, 13));
    EXPECT_THAT(example_shapes(catalog_, run_.id(), "cup", 1, 0, 1000), ElementsAre(1));
    EXPECT_THAT(example_shapes(catalog_, run_.id(), "chair", 3, 3, 1000), ElementsAre(14));
    EXPECT_THAT(example_shapes(catalog_, run_.id(), "none", 3, 3, 1000), IsEmpty());
}

TEST_F(RunSummaryTest, ExamplesOfFewShapesAreAllOfThemOnce) {
    for (int count = 1; count <= 6; ++count) {
        add(record("cup", 0.1 * count, {}));
        EXPECT_EQ(example_shapes(catalog_, run_.id(), "cup", 3, 3, 1000).size(), static_cast<std::size_t>(count));
    }
}

TEST_F(RunSummaryTest, LargeShapesAreNoExamples) {
    add(record("cup", 0.1, {}), 5000);
    add(record("cup", 0.2, {}), 50);
    EXPECT_THAT(example_shapes(catalog_, run_.id(), "cup", 3, 3, 1000), ElementsAre(2));
}

}  // namespace
}  // namespace exemplar
