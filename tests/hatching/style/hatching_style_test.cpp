#include "host/hatching/style/hatching_style.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <limits>
#include <numeric>
#include <ostream>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/random.h"
#include "host/data/safetensors.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/style/pixel_classifier.h"
#include "host/hatching/style/style_prediction.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

fs::path temporary(const std::string& name) {
    // Tests run beside each other.
    const std::string test = testing::UnitTest::GetInstance()->current_test_info()->name();
    return fs::path(testing::TempDir()) / fmt::format("exemplar_hatching_{}_{}", test, name);
}

CalibratedStumps classifier(std::uint32_t classes, std::uint32_t feature) {
    CalibratedStumps result;
    result.stumps.class_count = classes;
    result.stumps.stumps = {{feature, 0.1f, 1.5f, -0.75f, 1}, {4, -0.2f, 0.5f, -1.25f, 2}};
    result.stumps.elsewhere.assign(2 * std::size_t{classes}, 0.25f);
    result.stumps.elsewhere[0] = result.stumps.elsewhere[classes + 1] = 0;
    result.link = Link::sigmoid;
    result.scale = 1.3f;
    return result;
}

/// Two segments, the first cross-hatched; all classifiers and properties depend on features, some on contextual ones.
HatchingStyle small_style() {
    constexpr std::uint32_t k_context = k_powers * k_pixel_features;
    HatchingStyle style;
    style.name = "horse \"1\".png";
    style.width = 640;
    style.height = 480;
    style.taper = 2.5f;
    style.outline_width = 1.5f;
    style.object_size = 410.25f;
    style.rules.resize(2);
    style.rules[0].function[0].terms = {{3, 0.75f}, {40, -0.25f}};
    style.rules[0].function[1].terms = {{12, 1.0f}};
    style.rules[1].function[0].terms = {{69, 0.1f}};
    style.share = {0.7, 0.3};
    style.corrections[0] = {{0.75f, 0.5f}, {{17, 0.5f, 3, -0.25f, 0.125f}, {300, -1.0f, 9, 0.0625f, 0.5f}}};
    style.segments = {classifier(2, 17), classifier(2, k_context + 5)};
    style.boundary = classifier(2, k_context - 1);
    style.levels = classifier(3, 5);
    style.rough_levels = classifier(3, 9);
    const std::size_t familiar = familiar_features().size();
    style.familiarity = {std::vector<float>(familiar, 0.5f), std::vector<float>(familiar, 2.0f),
                         std::vector<float>(2 * familiar, 0.25f), 0.75f};
    style.segment_crf = {0.5f, -1.75f};
    style.level_crf = {1.25f, -0.75f};
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        const auto k = static_cast<std::uint32_t>(p);
        style.properties[p].factor = 1.5f + static_cast<float>(p);
        style.properties[p].terms = {{8 * k, 0.4f, 2.0f, -0.5f, -3.0f, 3.0f, 0.01f},
                                     {k_context + 4 * k, 0.7f, 1.0f, 1.0f, 0.0f, 1.0f, 0.2f}};
    }
    return style;
}

/// Saves a style after changing its file and returns the error of loading it, the path replaced by FILE.
std::string error_after(const std::function<void(TensorFile&)>& change) {
    const fs::path path = temporary("changed.safetensors");
    save_hatching_style(path, small_style());
    TensorFile file = read_safetensors(path);
    change(file);
    write_safetensors(path, file);
    try {
        load_hatching_style(path);
    } catch (const ModelError& error) {
        const std::string text = error.what();
        EXPECT_THAT(text, StartsWith(path.string() + ": "));
        EXPECT_EQ(text.find('\n'), std::string::npos);
        return "FILE" + text.substr(path.string().size());
    }
    return "no error";
}

template <typename T>
void replace(TensorFile& file, const std::string& name, std::vector<std::size_t> shape, const std::vector<T>& values) {
    file.tensors.erase(name);
    file.add(name, std::move(shape), values);
}

TEST(HatchingStyleFile, RoundTripKeepsEverythingAndTheBytes) {
    const fs::path path = temporary("round.safetensors"), again = temporary("again.safetensors");
    const HatchingStyle style = small_style();
    save_hatching_style(path, style);
    const HatchingStyle loaded = load_hatching_style(path);
    EXPECT_EQ(loaded.name, style.name);
    EXPECT_EQ(loaded.width, style.width);
    EXPECT_EQ(loaded.height, style.height);
    EXPECT_EQ(loaded.rules, style.rules);
    EXPECT_EQ(loaded.share, style.share);
    EXPECT_EQ(loaded.corrections, style.corrections);
    EXPECT_EQ(loaded.familiarity, style.familiarity);
    EXPECT_EQ(loaded.segment_crf, style.segment_crf);
    EXPECT_EQ(loaded.level_crf, style.level_crf);
    EXPECT_EQ(loaded.properties, style.properties);
    EXPECT_EQ(loaded.segments.size(), 2U);
    EXPECT_EQ(loaded.feature_count(), k_pixel_features + 10);
    save_hatching_style(again, loaded);
    EXPECT_EQ(read_file(path), read_file(again));
    EXPECT_EQ(describe_hatching_style(loaded), describe_hatching_style(style));
}

TEST(HatchingStyleFile, PartsAreFeaturesBeforeContextualOnes) {
    const fs::path path = temporary("parts.safetensors");
    HatchingStyle style = small_style();
    style.parts = {"head", "tail"};
    style.levels = classifier(3, k_powers * (k_pixel_features + 1));
    style.corrections[0].stumps[0].feature = k_pixel_features + 1;
    save_hatching_style(path, style);
    const HatchingStyle loaded = load_hatching_style(path);
    EXPECT_EQ(loaded.parts, style.parts);
    EXPECT_EQ(loaded.corrections, style.corrections);
    EXPECT_EQ(loaded.scalar_count(), k_pixel_features + 2);
    EXPECT_EQ(feature_name(loaded, k_powers * (k_pixel_features + 1)), "part.tail");
    EXPECT_EQ(feature_name(loaded, k_powers * (k_pixel_features + 2)), contextual_feature_names(2)[0]);
    EXPECT_THAT(describe_hatching_style(loaded), HasSubstr("part.tail"));
}

TEST(HatchingStyleFile, NamesThatAreNoTextDoNotPreventSaving) {
    const fs::path path = temporary("name.safetensors");
    HatchingStyle style = small_style();
    style.name = "h\xffrse.png";  // what old systems called a horse
    save_hatching_style(path, style);
    EXPECT_EQ(load_hatching_style(path).name, "h\xEF\xBF\xBDrse.png");
}

/// What a style says of random pixels: probabilities, directions, properties.
std::vector<float> predictions(const HatchingStyle& style) {
    constexpr std::size_t k_rows = 300;
    Random random(1);
    FeatureMatrix base;
    std::vector<std::uint32_t> which(style.feature_count());
    std::iota(which.begin(), which.end(), 0U);
    base.rows = k_rows;
    for (std::size_t k = 0; k < which.size(); ++k)
        for (float& value : base.add(std::to_string(k))) value = static_cast<float>(random.normal());
    OrientationFields fields(k_rows);
    for (DoubledAngle& v : fields.values) v = doubled_angle(static_cast<float>(random.uniform(0, 3)));

    std::vector<float> all;
    CpuStumpScorer scorer;
    for (const CalibratedStumps& stumps :
         {style.segments[0], style.segments[1], style.boundary, style.levels, style.rough_levels}) {
        const std::vector<float> some = classify(stumps, which, base, scorer);
        all.insert(all.end(), some.begin(), some.end());
    }
    CpuHatchingEvaluator evaluator;
    for (const PropertyModel& property : style.properties) {
        const std::vector<float> some = evaluator.property(property, which, base);
        all.insert(all.end(), some.begin(), some.end());
    }
    for (const OrientationRule& rule : style.rules)
        for (const OrientationFunction& function : rule.function)
            for (std::size_t i = 0; i < k_rows; ++i) {
                const DoubledAngle v = function.evaluate(fields, i);
                all.insert(all.end(), v.begin(), v.end());
            }
    return all;
}

TEST(HatchingStyleFile, RoundTripKeepsPredictionsToTheBit) {
    const fs::path path = temporary("predictions.safetensors");
    save_hatching_style(path, small_style());
    const std::vector<float> before = predictions(small_style());
    EXPECT_EQ(predictions(load_hatching_style(path)), before);
    HatchingStyle other = small_style();
    other.properties[2].terms[1].exponent = 0.9f;
    EXPECT_NE(predictions(other), before);
}

TEST(HatchingStyleFile, OtherVersionsAndKindsAreRefusedWithTheMend) {
    const auto with = [](const std::string& key, const std::string& value) {
        return error_after([&](TensorFile& file) { file.metadata[key] = value; });
    };
    const std::string known = std::to_string(k_hatching_feature_version);
    const std::string next = std::to_string(k_hatching_feature_version + 1);
    const std::string last = std::to_string(k_hatching_feature_version - 1);
    EXPECT_EQ(with("kind", "exemplar labeling model"),
              "FILE: is no hatching style; make one with 'exemplar hatch train'");
    EXPECT_EQ(with("format_version", "3"), "FILE: format_version is 3, this program knows 2; use a newer Exemplar");
    EXPECT_EQ(with("format_version", "1"), "FILE: format_version is 1, this program knows 2; train it again");
    EXPECT_EQ(with("feature_version", next),
              "FILE: feature_version is " + next + ", this program knows " + known + "; use a newer Exemplar");
    EXPECT_EQ(with("feature_version", last), "FILE: feature_version is " + last + ", this program knows " + known +
                                                 "; its features have changed: train it again");
    EXPECT_EQ(with("format_version", "new"), "FILE: damaged file: format_version is no number; train it again");
    EXPECT_EQ(error_after([](TensorFile& file) { file.metadata.erase("kind"); }),
              "FILE: is no hatching style; make one with 'exemplar hatch train'");
}

TEST(HatchingStyleFile, CorrectionsThatDoNotFitAreRefused) {
    using Numbers = std::vector<std::uint32_t>;
    const auto with_numbers = [](const Numbers& numbers) {
        return error_after([&](TensorFile& file) { replace(file, "direction.0.feature_part", {2, 2}, numbers); });
    };
    EXPECT_EQ(with_numbers({17, 3, 301, 9}), "FILE: damaged file: direction.0 uses feature 301 of 301; train it again");
    EXPECT_EQ(with_numbers({17, 10, 300, 9}),
              "FILE: damaged file: direction.0 uses direction 10 of 10; train it again");
    EXPECT_EQ(error_after([](TensorFile& file) {
                  replace(file, "direction.0.rule_weight", {3}, std::vector<float>{1, 1, 1});
              }),
              "FILE: damaged file: direction.0 is of 3 segments of 2; train it again");
    EXPECT_EQ(
        error_after([](TensorFile& file) { replace(file, "direction.0.rule_weight", {0}, std::vector<float>{}); }),
        "FILE: damaged file: direction.0 has stumps, but no weights of rules; train it again");
}

TEST(HatchingStyleFile, FamiliarityThatDoesNotFitIsRefused) {
    const auto with = [](const std::string& name, std::vector<std::size_t> shape, const std::vector<float>& values) {
        return error_after([&](TensorFile& file) { replace(file, name, shape, values); });
    };
    EXPECT_EQ(with("familiarity.reach", {1}, {0}),
              "FILE: damaged file: familiarity.reach is not positive; train it again");
    EXPECT_EQ(with("familiarity.offset", {3}, {1, 2, 3}),
              "FILE: damaged file: familiarity is judged by 3 features of 12; train it again");
}

// What opens files of any kind asks before it loads one.
TEST(HatchingStyleFile, SaysWhetherItIsAStyle) {
    const fs::path path = temporary("kind.safetensors");
    save_hatching_style(path, small_style());
    EXPECT_TRUE(is_hatching_style(path));
    TensorFile file = read_safetensors(path);
    file.metadata["format_version"] = "3";  // that of a newer program is one, too, which loading it then tells
    write_safetensors(path, file);
    EXPECT_TRUE(is_hatching_style(path));
    file.metadata["kind"] = "exemplar curvature";
    write_safetensors(path, file);
    EXPECT_FALSE(is_hatching_style(path));
    file.metadata.erase("kind");
    write_safetensors(path, file);
    EXPECT_FALSE(is_hatching_style(path));
    write_file_atomically(path, [](std::ostream& out) { out << "no model at all"; });
    EXPECT_THROW(is_hatching_style(path), ModelError);
}

TEST(HatchingStyleFile, FilesCutAnywhereAreRefused) {
    const fs::path path = temporary("whole.safetensors"), cut = temporary("cut.safetensors");
    save_hatching_style(path, small_style());
    const std::string content = read_file(path);
    for (std::size_t size = 0; size < content.size(); size += size < 16 ? 1 : 97) {
        write_file_atomically(cut, [&](std::ostream& out) { out << content.substr(0, size); });
        EXPECT_THROW(load_hatching_style(cut), ModelError) << size;
    }
    EXPECT_THROW(load_hatching_style(temporary("not_there.safetensors")), Error);
}

TEST(HatchingStyleFile, EveryArrayIsNeeded) {
    const fs::path path = temporary("arrays.safetensors");
    save_hatching_style(path, small_style());
    for (const auto& array : read_safetensors(path).tensors) {
        const std::string& name = array.first;
        const std::string error = error_after([&](TensorFile& file) { file.tensors.erase(name); });
        EXPECT_THAT(error, HasSubstr(name));
        const std::string other = error_after([&](TensorFile& file) {
            file.tensors[name].shape.push_back(1);  // another shape, the same bytes
        });
        EXPECT_THAT(other, HasSubstr(name));
    }
}

TEST(HatchingStyleFile, WhatContradictsItselfIsRefused) {
    const auto damaged = [](const std::string& what) { return "FILE: damaged file: " + what + "; train it again"; };
    const auto nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(error_after([](TensorFile& f) {
                  replace<std::uint32_t>(f, "rule.0.0.feature", {2}, {3, 76});
              }),
              damaged("rule.0.0 uses orientation feature 76 of 76"));
    EXPECT_EQ(error_after([&](TensorFile& f) { replace<float>(f, "rule.1.0.weight", {1}, {nan}); }),
              damaged("rule.1.0.weight holds a value that is not finite"));
    EXPECT_EQ(error_after([](TensorFile& f) { replace<float>(f, "spacing.factor", {1}, {0}); }),
              damaged("spacing.factor is not positive"));
    EXPECT_EQ(error_after([](TensorFile& f) {
                  replace<std::uint32_t>(f, "length.feature", {2}, {0, 1244});
              }),
              damaged("length uses feature 1244 of 1244"));
    const std::vector<float> no_range{1, 1, 1, 2, 1, 0.1f, 1, 1, 1, 0, 1, 0.1f},
        no_least{1, 1, 1, 0, 1, 0, 1, 1, 1, 0, 1, 0.1f};
    const std::string terms = "thickness.a_b_exponent_low_high_least";
    EXPECT_EQ(error_after([&](TensorFile& f) {
                  replace<float>(f, terms, {2, 6}, no_range);
              }),
              damaged("thickness has a term without a range"));
    EXPECT_EQ(error_after([&](TensorFile& f) {
                  replace<float>(f, terms, {2, 6}, no_least);
              }),
              damaged("thickness has a term without a least value"));
    // Contextual features are known only once segments are: neither to the first of the cascade nor to boundaries.
    for (const std::string name : {"segments.0", "boundary"})
        EXPECT_EQ(error_after([&](TensorFile& f) {
                      replace<std::uint32_t>(f, name + ".feature", {2}, {1204, 4});
                  }),
                  damaged(name + " uses feature 1204 of 1204"));
    EXPECT_EQ(error_after([](TensorFile& f) {
                  replace<std::uint64_t>(f, "levels.classes", {2}, {1, 8});
              }),
              damaged("levels has a stump of more than 3 classes"));
    EXPECT_EQ(error_after([](TensorFile& f) { replace<std::uint32_t>(f, "levels.link", {1}, {2}); }),
              damaged("levels.link is unknown"));
}

TEST(HatchingStyleFile, OddDescriptionsAreRefused) {
    const auto with = [](const std::string& from, const std::string& to) {
        return error_after([&](TensorFile& file) {
            std::string& text = file.metadata["style"];
            const std::size_t at = text.find(from);
            ASSERT_NE(at, std::string::npos) << from;
            text.replace(at, from.size(), to);
        });
    };
    const auto damaged = [](const std::string& what) { return "FILE: damaged file: " + what + "; train it again"; };
    const std::string unreadable = damaged("its description cannot be read"),
                      no_width = damaged("'width' is 0, which is not a whole number from 1 to 32768");
    EXPECT_EQ(with("\"width\":640", "\"width\":0"), no_width);
    for (const char* bad : {"-480", "1000000", "47.5", "1e300"})
        EXPECT_THAT(with("\"height\":480", fmt::format("\"height\":{}", bad)), HasSubstr("'height' is")) << bad;
    EXPECT_EQ(with("\"height\":480", "\"height\":\"tall\""), unreadable);
    EXPECT_EQ(with("\"height\":480,", ""), unreadable);
    for (const char* bad : {"-1", "1001", "1e300"})
        EXPECT_THAT(with("\"taper\":2.5", fmt::format("\"taper\":{}", bad)), HasSubstr("'taper' is")) << bad;
    EXPECT_THAT(with("\"object_size\":410.25", "\"object_size\":-1"), HasSubstr("'object_size' is"));
    EXPECT_EQ(with("{", "["), unreadable);
    EXPECT_EQ(with("[0.7,0.3]", "[]"), damaged("it has 0 segments"));
    EXPECT_EQ(with("\"stages\":2", "\"stages\":0"), damaged("'stages' is 0, which is not a whole number from 1 to 16"));
    for (const char* strength : {"0.5", "1.25"})
        EXPECT_EQ(with(fmt::format("\"strength\":{}", strength), "\"strength\":-0.5"),
                  damaged("a weight of its label cuts is out of range"));
    EXPECT_THAT(with("[0.7,0.3]", "[0.7,0.2,0.1]"), HasSubstr("rule.2.0"));
    EXPECT_THAT(with("\"stages\":2", "\"stages\":3"), HasSubstr("segments.2"));
}

TEST(HatchingStyleText, NamesRulesAndFeatures) {
    const std::string text = describe_hatching_style(small_style());
    EXPECT_THAT(text, HasSubstr("Segment 1 (70% of the strokes): hatches along 0.75 k_min,1"));
    EXPECT_THAT(text, HasSubstr("+ 0.25 k_min,3; crossed along"));  // 40 is that, turned; its weight turns it back
    EXPECT_THAT(text, HasSubstr("Segment 2 (30% of the strokes)"));
    EXPECT_THAT(text, HasSubstr("length = 4.5 * ("));
    EXPECT_THAT(text, EndsWith("\n"));
    const HatchingStyle style = small_style();
    EXPECT_EQ(feature_name(style, 7), "1/" + pixel_feature_names()[1] + "^2");
    EXPECT_EQ(feature_name(style, k_powers * k_pixel_features + 1), contextual_feature_names(2)[0] + "^2");
}

// A picture of another size is drawn by a pen that grows with its shorter side.
TEST(HatchingStyle, IsRestatedForPicturesOfOtherSizes) {
    const HatchingStyle before = small_style();
    HatchingStyle style = before;
    style.resize(2000, 960);
    EXPECT_EQ(style.width, 2000);
    EXPECT_EQ(style.height, 960);
    EXPECT_FLOAT_EQ(style.taper, 2 * before.taper);
    EXPECT_FLOAT_EQ(style.outline_width, 2 * before.outline_width);
    EXPECT_EQ(style.object_size, before.object_size);  // of the drawing
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        const float factor = p == static_cast<std::size_t>(StrokeProperty::intensity) ? 1 : 2;
        EXPECT_FLOAT_EQ(style.properties[p].factor, factor * before.properties[p].factor);
    }
    style.resize(640, 480);
    EXPECT_FLOAT_EQ(style.properties[0].factor, before.properties[0].factor);
}

}  // namespace
}  // namespace exemplar
