#include "host/labeling/category/category_model.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/data/safetensors.h"
#include "host/labeling/category/category_evaluation.h"
#include "host/labeling/category/category_training.h"
#include "host/synth/shapes/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_features = 20;

std::vector<std::string> feature_names() {
    std::vector<std::string> names;
    for (std::size_t k = 0; k < k_features; ++k) names.push_back(fmt::format("f{}", k));
    return names;
}

/// A shape near the center of cluster `cluster`, whose values are far apart from those of others.
ShapeDescriptor made_up_shape(std::size_t cluster, Random& random) {
    ShapeDescriptor shape{feature_names(), {}};
    Random center = Random(7).fork(cluster);
    for (std::size_t k = 0; k < k_shape_statistics * k_features; ++k)
        shape.values.push_back(static_cast<float>(10 + 3 * center.normal() + 0.3 * random.normal()));
    return shape;
}

CategorizedShapes made_up_shapes(const std::vector<std::size_t>& counts, std::uint64_t seed = 1) {
    CategorizedShapes shapes;
    Random random(seed);
    for (std::size_t c = 0; c < counts.size(); ++c) {
        shapes.category_names.push_back(fmt::format("kind{}", c));
        for (std::size_t i = 0; i < counts[c]; ++i) {
            shapes.shapes.push_back(made_up_shape(c, random));
            shapes.category.push_back(static_cast<std::int32_t>(c));
            shapes.provenance.push_back(fmt::format("shape {}", i));
        }
    }
    return shapes;
}

CategoryModel trained_categories(const CategorizedShapes& shapes, std::uint64_t seed = 1) {
    CategoryReport report;
    return train_categories(shapes, {.seed = seed}, report);
}

std::string bytes_of(const CategoryModel& model) {
    const TemporaryFolder folder;
    save_category_model(folder / "model", model);
    return read_file(folder / "model");
}

TEST(Categories, AreRecognizedAndStrangersAreUnknown) {
    const std::vector<std::size_t> counts{6, 3, 12, 1, 6};
    CategoryReport report;
    const CategoryModel model = train_categories(made_up_shapes(counts), {}, report);
    EXPECT_EQ(report.right, 1);
    EXPECT_EQ(report.called_unknown, 0);
    EXPECT_GT(report.strangers_unknown, 0.9);
    EXPECT_FALSE(report.strangers_made_up);
    Random random(99);
    for (std::size_t c = 0; c < 15; ++c) {
        const CategoryPrediction prediction = recognize(model, made_up_shape(c, random));
        EXPECT_EQ(prediction.category, c < counts.size() ? static_cast<std::int32_t>(c) : -1) << c;
        EXPECT_NEAR(std::accumulate(prediction.probability.begin(), prediction.probability.end(), 0.0F), 1, 1e-5F);
        EXPECT_EQ(prediction.category >= 0, prediction.confidence >= 0.5F);
    }
}

TEST(Categories, WorkWithTwoAndWithMany) {
    Random random(5);
    CategoryReport report;
    const CategoryModel two = train_categories(made_up_shapes({2, 2}), {}, report);
    EXPECT_TRUE(report.strangers_made_up);
    for (std::size_t c = 0; c < 2; ++c)
        EXPECT_EQ(recognize(two, made_up_shape(c, random)).category, static_cast<std::int32_t>(c));
    ShapeDescriptor between = made_up_shape(0, random);
    const ShapeDescriptor other = made_up_shape(1, random);
    for (std::size_t k = 0; k < between.values.size(); ++k)
        between.values[k] = (between.values[k] + other.values[k]) / 2;
    EXPECT_EQ(recognize(two, between).category, -1);

    const CategoryModel many = train_categories(made_up_shapes(std::vector<std::size_t>(40, 3)), {}, report);
    for (std::size_t c = 0; c < 40; ++c)
        EXPECT_EQ(recognize(many, made_up_shape(c, random)).category, static_cast<std::int32_t>(c));
}

TEST(Categories, NoiseIsNotRecognized) {
    CategorizedShapes shapes = made_up_shapes({8, 8, 8});
    Random random(3);
    for (ShapeDescriptor& shape : shapes.shapes)
        for (float& value : shape.values) value = static_cast<float>(random.normal());
    CategoryReport report;
    train_categories(shapes, {}, report);
    EXPECT_LT(report.nearest_right, 0.7);
    EXPECT_GT(report.called_unknown, 0.4) << "nothing is to be known, so nothing should be said";
}

TEST(Categories, MoreShapesThanValuesAreLearnedAsWell) {
    CategoryReport report;
    const std::size_t values = k_shape_statistics * k_features;
    const CategoryModel model = train_categories(made_up_shapes({values / 2, values / 2, values / 2}), {}, report);
    EXPECT_NEAR(report.right, 1, 1e-12);  // a sum of weights
    EXPECT_GT(report.strangers_unknown, 0.9);
    Random random(99);
    for (std::size_t c = 0; c < 6; ++c)
        EXPECT_EQ(recognize(model, made_up_shape(c, random)).category, c < 3 ? static_cast<std::int32_t>(c) : -1) << c;
}

TEST(Categories, CopiesAreHeldOutTogether) {
    CategorizedShapes shapes = made_up_shapes({8, 8, 8});
    Random random(3);
    for (std::size_t i = 0; i < shapes.shapes.size(); ++i)
        for (std::size_t k = 0; k < shapes.shapes[i].values.size(); ++k)
            shapes.shapes[i].values[k] =
                i % 2 == 1 ? shapes.shapes[i - 1].values[k] : static_cast<float>(random.normal());
    CategoryReport report;
    train_categories(shapes, {}, report);
    EXPECT_LT(report.nearest_right, 0.7) << "noise is known by its copies only";
    EXPECT_THROW(
        {
            for (ShapeDescriptor& shape : shapes.shapes) shape = shapes.shapes[0];
            train_categories(shapes, {}, report);
        },
        UsageError);
}

TEST(Categories, UnitsOfFeaturesDoNotMatterNorDoSingleOddValues) {
    CategorizedShapes shapes = made_up_shapes({5, 5, 5}), scaled = shapes;
    for (ShapeDescriptor& shape : scaled.shapes) shape.values[3] = 1000 * shape.values[3] - 7;
    Random random(6);
    ShapeDescriptor shape = made_up_shape(1, random), other = shape;
    other.values[3] = 1000 * shape.values[3] - 7;
    EXPECT_NEAR(recognize(trained_categories(shapes), shape).confidence,
                recognize(trained_categories(scaled), other).confidence, 1e-4F);
    for (const float odd : {1e30F, -1e30F}) {
        shape.values[5] = odd;
        EXPECT_EQ(recognize(trained_categories(shapes), shape).category, 1);
    }
}

TEST(Categories, AConstantFeatureTellsNothing) {
    CategorizedShapes shapes = made_up_shapes({4, 4, 4});
    for (ShapeDescriptor& shape : shapes.shapes) shape.values[2] = 3;
    Random random(6);
    ShapeDescriptor shape = made_up_shape(2, random);
    const float before = recognize(trained_categories(shapes), shape).confidence;
    shape.values[2] = -50;
    EXPECT_EQ(recognize(trained_categories(shapes), shape).confidence, before);
}

TEST(Categories, EqualSeedsGiveEqualBytesOnAnyNumberOfThreads) {
    const CategorizedShapes shapes = made_up_shapes({6, 12, 4});
    const std::string bytes = bytes_of(trained_categories(shapes, 5));
    EXPECT_EQ(bytes_of(trained_categories(shapes, 5)), bytes);
    CategoryModel other = trained_categories(shapes, 6);
    other.seed = 5;
    EXPECT_NE(bytes_of(other), bytes) << "other folds";
    const ThreadLimit limit(1);
    EXPECT_EQ(bytes_of(trained_categories(shapes, 5)), bytes);
}

TEST(Categories, WhatCannotBeLearnedIsRefusedWithTheMend) {
    const auto error = [](const std::function<void(CategorizedShapes&)>& change) -> std::string {
        CategorizedShapes shapes = made_up_shapes({3, 3});
        change(shapes);
        try {
            trained_categories(shapes);
        } catch (const UsageError& refused) {
            return refused.what();
        }
        return "no error";
    };
    using testing::HasSubstr;
    EXPECT_THAT(error([](auto& s) { s = made_up_shapes({4}); }), HasSubstr("two at least"));
    EXPECT_THAT(error([](auto& s) { s = made_up_shapes({1, 1, 1}); }), HasSubstr("give two of one"));
    EXPECT_THAT(error([](auto& s) { s = made_up_shapes({3, 0, 3}); }), HasSubstr("'kind1' has no meshes"));
    EXPECT_THAT(error([](auto& s) { s.category_names[1] = "unknown"; }), HasSubstr("rename"));
    EXPECT_THAT(error([](auto& s) { s.category_names[1] = "two\nlines"; }), HasSubstr("rename"));
    EXPECT_THAT(error([](auto& s) { s.category_names[1] = "kind0"; }), HasSubstr("two categories"));
    EXPECT_THAT(error([](auto& s) { s.category[0] = 2; }), HasSubstr("category 2"));
    EXPECT_THAT(error([](auto& s) { s.category.pop_back(); }), HasSubstr("number"));
    EXPECT_THAT(error([](auto& s) { s.shapes[0].features[0] = "other"; }), HasSubstr("same options"));
}

TEST(Categories, TheLeastConfidenceIsTheOnlyDifferenceThatItMakes) {
    const CategorizedShapes shapes = made_up_shapes({4, 4, 4});
    CategoryReport usual_report, strict_report, lax_report;
    const CategoryModel usual = train_categories(shapes, {}, usual_report);
    CategoryModel strict = train_categories(shapes, {.min_confidence = 1}, strict_report);
    train_categories(shapes, {.min_confidence = 0}, lax_report);
    EXPECT_EQ(strict.min_confidence, 1);
    Random random(8);
    EXPECT_EQ(recognize(usual, made_up_shape(1, random)).category, 1);
    EXPECT_EQ(recognize(strict, made_up_shape(1, random)).category, -1);
    EXPECT_EQ(strict_report.called_unknown, 1);
    EXPECT_EQ(strict_report.nearest_right, usual_report.nearest_right);
    EXPECT_EQ(lax_report.called_unknown, 0);
    EXPECT_EQ(lax_report.strangers_unknown, 0);
    strict.min_confidence = usual.min_confidence;
    EXPECT_EQ(bytes_of(strict), bytes_of(usual));
    for (const double bad : {-0.1, 1.1, static_cast<double>(NAN)})
        EXPECT_THROW(train_categories(shapes, {.min_confidence = bad}, usual_report), UsageError) << bad;
}

TEST(Categories, OtherFeaturesAreRefused) {
    Random random(1);
    ShapeDescriptor shape = made_up_shape(0, random);
    shape.features[0] = "other";
    EXPECT_THROW(recognize(trained_categories(made_up_shapes({3, 3})), shape), UsageError);
}

TEST(Categories, GeneratedShapesAreRecognizedAndAnotherKindIsUnknown) {
    const std::vector<std::string> kinds{"cup", "human", "octopus"};
    FeatureOptions options;
    options.samples = 300;
    const auto features_of = [&](const std::string& kind, std::uint64_t seed) {
        return compute_features(make_shape(kind, seed, 1000, true).mesh, options);
    };
    CategorizedShapes shapes{kinds, options, {}, {}, {}};
    for (std::size_t c = 0; c < kinds.size(); ++c)
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            shapes.shapes.push_back(compute_shape_descriptor(features_of(kinds[c], seed)));
            shapes.category.push_back(static_cast<std::int32_t>(c));
            shapes.provenance.push_back(kinds[c]);
        }
    const CategoryModel model = trained_categories(shapes);
    for (std::size_t c = 0; c < kinds.size(); ++c)
        for (std::uint64_t seed = 11; seed <= 12; ++seed)
            EXPECT_EQ(recognize(model, features_of(kinds[c], seed)).category, static_cast<std::int32_t>(c)) << kinds[c];
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
        EXPECT_EQ(recognize(model, features_of("glasses", seed)).category, -1) << seed;
}

TEST(CategoryEvaluation, TestsWhatWasNotTrainedOn) {
    const CategorizedShapes all = made_up_shapes({5, 5, 5, 5});
    Split split;
    for (std::size_t i = 0; i < 20; ++i) (i % 5 < 3 ? split.train : split.test).push_back(i);
    const CategoryTest test = test_categories(all, split, {});
    ASSERT_EQ(test.shapes.size(), 8U);
    ASSERT_EQ(test.strangers.size(), 8U);
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(test.shapes[i].shape, split.test[i]);
        EXPECT_EQ(test.shapes[i].called, all.category[split.test[i]]);
        EXPECT_NE(test.strangers[i].nearest, all.category[test.strangers[i].shape]) << "that category was not learned";
    }
    const std::vector<std::size_t> confusion = category_confusion(all, test.shapes);
    ASSERT_EQ(confusion.size(), 20U);
    for (std::size_t t = 0; t < 4; ++t)
        for (std::size_t p = 0; p < 5; ++p) EXPECT_EQ(confusion[t * 5 + p], t == p ? 2U : 0U);
    EXPECT_EQ(category_confusion(all, {{7, -1, 0, 0}})[1 * 5 + 4], 1U) << "unknown is the last column";
}

TEST(CategoryEvaluation, DoesNotKnowWhatItTests) {
    CategorizedShapes all = made_up_shapes({12, 12, 12});
    Random random(4);
    for (ShapeDescriptor& shape : all.shapes)
        for (float& value : shape.values) value = static_cast<float>(random.normal());
    Split split;
    for (std::size_t i = 0; i < 36; ++i) (i % 2 ? split.train : split.test).push_back(i);
    const CategoryTest test = test_categories(all, split, {});
    const auto right = std::ranges::count_if(
        test.shapes, [&](const RecognizedShape& shape) { return shape.nearest == all.category[shape.shape]; });
    EXPECT_LT(right, 13) << "of 18 shapes of noise in three categories";
}

/// A split of made-up shapes, which come in the order of their categories: of each category the first `train_count`
/// train.
Split split_of(const CategorizedShapes& all, const std::vector<std::size_t>& train_count) {
    Split split;
    std::vector<std::size_t> seen(train_count.size(), 0);
    for (std::size_t i = 0; i < all.category.size(); ++i) {
        const auto category = static_cast<std::size_t>(all.category[i]);
        (seen[category]++ < train_count[category] ? split.train : split.test).push_back(i);
    }
    return split;
}

TEST(CategoryEvaluation, ACategoryThatTheOthersNeedIsNotLeftOut) {
    const CategorizedShapes all = made_up_shapes({3, 2, 2});
    const Split split = split_of(all, {2, 1, 1});  // without the first, each category has one shape
    EXPECT_EQ(indispensable_categories(all.category_names, all.category, split), std::vector<std::int32_t>{0});
    const CategoryTest test = test_categories(all, split, {});
    EXPECT_EQ(test.shapes.size(), 3U);
    ASSERT_EQ(test.strangers.size(), 2U);
    for (const RecognizedShape& shape : test.strangers) EXPECT_GT(all.category[shape.shape], 0);

    const CategorizedShapes two = made_up_shapes({3, 3});
    const Split of_two = split_of(two, {2, 2});
    EXPECT_EQ(indispensable_categories(two.category_names, two.category, of_two), (std::vector<std::int32_t>{0, 1}));
    EXPECT_TRUE(test_categories(two, of_two, {}).strangers.empty());

    const CategorizedShapes many = made_up_shapes({3, 3, 3});
    EXPECT_TRUE(indispensable_categories(many.category_names, many.category, split_of(many, {2, 2, 2})).empty());
    for (const auto& counts : std::vector<std::vector<std::size_t>>{{1, 1, 1}, {2, 2, 0}})
        EXPECT_THROW(indispensable_categories(many.category_names, many.category, split_of(many, counts)), UsageError);
}

/// Saves a model after changing its file and returns the error of loading it.
std::string category_error_after(const std::function<void(TensorFile&)>& change) {
    const TemporaryFolder folder;
    save_category_model(folder / "model", trained_categories(made_up_shapes({2, 2})));
    TensorFile file = read_safetensors(folder / "model");
    change(file);
    write_safetensors(folder / "model", file);
    try {
        load_category_model(folder / "model");
    } catch (const ModelError& error) {
        return error.what();
    }
    return "no error";
}

TEST(CategoryModelFile, RoundTripKeepsEverythingAndTheBytes) {
    const TemporaryFolder folder;
    CategorizedShapes shapes = made_up_shapes({3, 4, 5});
    shapes.feature_options.samples = 123;
    const CategoryModel model = trained_categories(shapes, 18446744073709551615ULL);
    save_category_model(folder / "model", model);
    const CategoryModel again = load_category_model(folder / "model");
    EXPECT_EQ(again.category_names, model.category_names);
    EXPECT_EQ(again.feature_options.samples, 123U);
    EXPECT_EQ(again.features, model.features);
    EXPECT_EQ(again.provenance, shapes.provenance);
    EXPECT_EQ(again.seed, model.seed);
    Random random(2);
    const ShapeDescriptor shape = made_up_shape(1, random);
    EXPECT_EQ(recognize(again, shape).confidence, recognize(model, shape).confidence);
    EXPECT_EQ(recognize(again, shape).probability, recognize(model, shape).probability);
    EXPECT_EQ(bytes_of(again), bytes_of(model));
}

TEST(CategoryModelFile, NamesOfMeshesMayBeInAnyEncoding) {
    const TemporaryFolder folder;
    CategorizedShapes shapes = made_up_shapes({2, 2});
    shapes.provenance[1] = "kind0 caf\xe9 0123";
    save_category_model(folder / "model", trained_categories(shapes));
    EXPECT_EQ(load_category_model(folder / "model").provenance[1], "kind0 caf\xEF\xBF\xBD 0123");
}

TEST(CategoryModelFile, OtherVersionsAndKindsAreRefusedWithTheMend) {
    using testing::HasSubstr;
    EXPECT_THAT(category_error_after([](TensorFile& f) { f.metadata["format_version"] = "99"; }),
                HasSubstr("a newer Exemplar"));
    for (const char* key : {"feature_version", "descriptor_version"})
        EXPECT_THAT(category_error_after([&](TensorFile& f) { f.metadata[key] = "0"; }), HasSubstr("train it again"));
    EXPECT_THAT(category_error_after([](TensorFile& f) { f.metadata["kind"] = "exemplar mesh labeling"; }),
                HasSubstr("category train"));
}

void replace_in_category(std::string& text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    text.replace(at, what.size(), by);
}

TEST(CategoryModelFile, InconsistentContentIsRefused) {
    const std::vector<std::pair<std::string, std::string>> replacements{
        {"\"kind1\"", "\"kind0\""},
        {"\"kind1\"", "\"unknown\""},
        {",\"kind1\"", ""},
        {"\"f3\"", "\"f3\",\"f3b\""},
        {"\"f3\"", "\"orientation.x\""},
        {"\"samples\":", "\"samples\":-"},
        {"\"samples\":1000", "\"samples\":0"},
        {"\"sharpness\":", "\"sharpness\":-"},
        {"\"evidence_slope\":", "\"evidence_slope\":-"},
        {"\"least_confidence\":", "\"least_confidence\":2"},
        {"\"seed\":1", "\"seed\":1.5"},
        {"\"features\"", "\"feature\""}};
    for (const auto& pair : replacements)
        EXPECT_NE(category_error_after(
                      [&](TensorFile& f) { replace_in_category(f.metadata["model"], pair.first, pair.second); }),
                  "no error")
            << pair.second;
    for (const char* name : {"mean", "inverse_deviation", "weights", "offset"})
        EXPECT_NE(category_error_after([&](TensorFile& f) { f.tensors.erase(name); }), "no error") << name;
    EXPECT_NE(category_error_after([](TensorFile& f) {
                  f.add("offset", {2}, std::vector<float>{NAN, 0});
              }),
              "no error");
    EXPECT_NE(category_error_after([](TensorFile& f) {
                  f.add("weights", {1, 2}, std::vector<float>{0, 0});
              }),
              "no error");
    EXPECT_NE(category_error_after([](TensorFile& f) { f.add("inverse_deviation", {60}, std::vector<float>(60, -1)); }),
              "no error");
    EXPECT_EQ(category_error_after([](TensorFile&) {}), "no error");
}

TEST(CategoryModelFile, MutationsNeverCrash) {
    const TemporaryFolder folder;
    save_category_model(folder / "model", trained_categories(made_up_shapes({2, 2})));
    const std::string good = read_file(folder / "model");
    Random random(11);
    const ShapeDescriptor shape = made_up_shape(0, random);
    for (int i = 0; i < 500; ++i) {
        std::string bytes = good.substr(0, random.uniform() < 0.3 ? random.index(good.size()) : good.size());
        for (std::size_t flips = random.index(4); flips > 0 && !bytes.empty(); --flips)
            bytes[random.index(bytes.size())] = static_cast<char>(random.next());
        write_file_atomically(folder / "model", [&](std::ostream& out) { out << bytes; });
        try {
            const CategoryModel model = load_category_model(folder / "model");
            for (const float p : recognize(model, shape).probability) ASSERT_TRUE(std::isfinite(p));
        } catch (const ModelError&) {
        } catch (const UsageError&) {  // it has other features than the shape
        }
    }
}

}  // namespace
}  // namespace exemplar
