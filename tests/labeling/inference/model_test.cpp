#include "host/labeling/inference/model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/random.h"
#include "host/data/safetensors.h"
#include "host/labeling/inference/mesh_turn.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

fs::path temporary(const std::string& name) {
    return fs::path(testing::TempDir()) / ("exemplar_model_" + name);
}

CalibratedStumps classifier(std::uint32_t classes, std::uint32_t feature) {
    CalibratedStumps result;
    result.stumps.class_count = classes;
    result.stumps.stumps = {{feature, 0.5F, 1.0F, -1.0F, 1}};
    result.stumps.elsewhere.assign(classes, 0.25F);
    result.stumps.elsewhere[0] = 0;
    result.link = Link::sigmoid;
    result.scale = 1.5F;
    return result;
}

/// Of so many features, the last of which does not vary.
LinearExpert linear(std::size_t features) {
    LinearExpert result{{2, {}, {}, {}, {0.5F, 0.5F}}, 4, 0.75F};
    for (std::size_t f = 0; f < features; ++f) {
        const auto x = static_cast<float>(f);
        result.classifier.mean.push_back(x);
        result.classifier.inverse.push_back(f + 1 < features ? x + 1 : 0);
        result.classifier.weight.insert(result.classifier.weight.end(), {0.1F * x, -0.1F * x});
    }
    return result;
}

LabelingModel small_model() {
    LabelingModel model;
    model.label_names = {"body", "leg"};
    model.label_colors = {Color{1, 2, 3}, Color{4, 5, 6}};
    model.unary_names = {"a.x", "a.y"};
    model.pairwise_names = {"b.z"};
    model.unary = {classifier(2, 1), classifier(2, 71)};
    model.pairwise = {classifier(2, 0), classifier(2, 5)};
    model.linear = {{}, linear(72)};
    model.averaged_labels = {1};
    model.crf.compatibility = {0, 1, 1, 0};
    model.smallest_component = {0.1F, 0.2F};
    model.provenance = {"horse 0123"};
    model.seed = 18446744073709551615ULL;
    return model;
}

/// Knows faces also by where they are.
LabelingModel oriented_model() {
    LabelingModel model = small_model();
    for (const std::string& name : orientation_names()) model.unary_names.push_back(name);
    model.linear = {{}, linear(75)};
    model.unoriented = classifier(2, 1);
    model.unoriented_linear = linear(2);
    return model;
}

/// Saves a model after changing its file and returns the error of loading it.
std::string error_after(const std::string& name, const std::function<void(TensorFile&)>& change,
                        const LabelingModel& model = small_model()) {
    const fs::path path = temporary(name);
    save_model(path, model);
    TensorFile file = read_safetensors(path);
    change(file);
    write_safetensors(path, file);
    try {
        load_model(path);
    } catch (const ModelError& error) {
        return error.what();
    }
    return "no error";
}

TEST(LabelingModelFile, RoundTripKeepsEverythingAndTheBytes) {
    const fs::path path = temporary("round.safetensors"), again = temporary("again.safetensors");
    save_model(path, small_model());
    const LabelingModel model = load_model(path);
    EXPECT_EQ(model.label_names, small_model().label_names);
    EXPECT_EQ(model.label_colors, small_model().label_colors);
    EXPECT_EQ(model.unary.size(), 2U);
    EXPECT_EQ(model.unary[1].stumps.stumps[0].feature, 71U);
    EXPECT_EQ(model.unary[1].link, Link::sigmoid);
    EXPECT_EQ(model.unary[1].scale, 1.5F);
    ASSERT_EQ(model.linear.size(), 2U);
    EXPECT_FALSE(model.linear[0].used());
    EXPECT_EQ(model.linear[1].classifier.class_count, 2U);
    EXPECT_EQ(model.linear[1].classifier.mean, linear(72).classifier.mean);
    EXPECT_EQ(model.linear[1].classifier.inverse, linear(72).classifier.inverse);
    EXPECT_EQ(model.linear[1].classifier.weight, linear(72).classifier.weight);
    EXPECT_EQ(model.linear[1].classifier.constant, linear(72).classifier.constant);
    EXPECT_EQ(model.linear[1].ratio, 4);
    EXPECT_EQ(model.linear[1].scale, 0.75F);
    EXPECT_EQ(model.averaged_labels, small_model().averaged_labels);
    EXPECT_EQ(model.seed, small_model().seed);
    EXPECT_EQ(model.smallest_component, small_model().smallest_component);
    save_model(again, model);
    EXPECT_EQ(read_file(path), read_file(again));
}

TEST(LabelingModelFile, AModelWithCoordinatesKeepsTheStageWithoutThem) {
    const fs::path path = temporary("oriented.safetensors"), again = temporary("oriented_again.safetensors");
    save_model(path, oriented_model());
    const LabelingModel model = load_model(path);
    EXPECT_EQ(model.unoriented.stumps.stumps.front().feature, 1U);
    EXPECT_EQ(model.unoriented_linear.classifier.weight, linear(2).classifier.weight);
    save_model(again, model);
    EXPECT_EQ(read_file(path), read_file(again));

    using File = TensorFile;
    const std::vector<std::function<void(File&)>> changes{
        [](File& f) { f.tensors.erase("unoriented.feature"); },
        [](File& f) { f.add("unoriented.feature", {1}, std::vector<std::uint32_t>{2}); },  // a coordinate
        [](File& f) { f.add("unoriented.linear.mean", {2}, std::vector<float>(2, NAN)); },
        [](File& f) { f.tensors.erase("unoriented.linear.constant"); },
    };
    for (std::size_t i = 0; i < changes.size(); ++i)
        EXPECT_NE(error_after("unoriented" + std::to_string(i), changes[i], oriented_model()), "no error") << i;
}

TEST(LabelingModelFile, NamesOfMeshesMayBeInAnyEncoding) {
    const fs::path path = temporary("encoding.safetensors");
    LabelingModel model = small_model();
    model.provenance = {"horse \xff 0123"};
    save_model(path, model);
    EXPECT_EQ(load_model(path).provenance, std::vector<std::string>{"horse \xEF\xBF\xBD 0123"});
}

TEST(LabelingModelFile, OtherVersionsAreRefusedWithTheMend) {
    EXPECT_THAT(error_after("newer", [](TensorFile& f) { f.metadata["format_version"] = "99"; }),
                testing::HasSubstr("use a newer Exemplar"));
    for (const char* key : {"format_version", "feature_version"})
        EXPECT_THAT(error_after("older", [&](TensorFile& f) { f.metadata[key] = "2"; }),
                    testing::HasSubstr("train it again"));
    EXPECT_THAT(error_after("text", [](TensorFile& f) { f.metadata["format_version"] = "x"; }),
                testing::HasSubstr("no number"));
}

void replace(std::string& text, const std::string& what, const std::string& by) {
    text.replace(text.find(what), what.size(), by);
}

TEST(LabelingModelFile, InconsistentContentIsRefused) {
    using File = TensorFile;
    const std::vector<std::function<void(File&)>> changes{
        [](File& f) { f.metadata.erase("kind"); },
        [](File& f) { f.metadata["kind"] = "something else"; },
        [](File& f) { f.metadata["model"] = "{"; },
        [](File& f) { f.metadata["model"] = "{}"; },
        [](File& f) { f.tensors.erase("unary.1.feature"); },
        [](File& f) { f.tensors.erase("smallest_component"); },
        [](File& f) { f.add("unary.0.feature", {1}, std::vector<std::uint32_t>{2}); },
        [](File& f) { f.add("unary.1.feature", {1}, std::vector<std::uint32_t>{72}); },
        [](File& f) { f.add("unary.0.scale", {1}, std::vector<float>{0}); },
        [](File& f) { f.add("unary.0.link", {1}, std::vector<std::uint32_t>{7}); },
        [](File& f) {
            f.add("unary.0.threshold_above_below", {1, 3}, std::vector<float>{0, NAN, 0});
        },
        [](File& f) { f.tensors.erase("linear.1.mean"); },
        [](File& f) {
            f.add("linear.1.constant", {3}, std::vector<float>{0, 0, 0});
        },
        [](File& f) { f.add("linear.1.mean", {72}, std::vector<float>(72, NAN)); },
        [](File& f) {
            f.add("linear.1.weight", {72, 2}, std::vector<float>(144, 1e30F));
        },
        [](File& f) {
            f.add("linear.1.ratio_scale", {2}, std::vector<float>{1, 0});
        },
        [](File& f) {
            f.add("linear.1.ratio_scale", {2}, std::vector<float>{-1, 1});
        },
        [](File& f) {
            f.add("linear.1.ratio_scale", {2}, std::vector<float>{1e38F, 1e38F});
        },
        [](File& f) {
            f.add("linear.0.weight", {72, 2}, std::vector<float>(144, 1));
        },
        [](File& f) { f.add("unary.0.classes", {1}, std::vector<std::uint64_t>{8}); },
        [](File& f) { replace(f.metadata["model"], "\"kappa\":", "\"kappa\":-"); },
        [](File& f) { replace(f.metadata["model"], "\"samples\":", "\"samples\":-"); },
        [](File& f) { replace(f.metadata["model"], "\"averaged_labels\":[1", "\"averaged_labels\":[2"); },
        [](File& f) { replace(f.metadata["model"], "\"averaged_labels\":[1]", "\"averaged_labels\":1"); },
        [](File& f) { replace(f.metadata["model"], "\"averaged_labels\":[1]", "\"averaged_labels\":[1,1]"); },
        [](File& f) {
            f.add("smallest_component", {2}, std::vector<float>{NAN, 0});
        },
        [](File& f) {
            f.add("unary.0.elsewhere", {1, 3}, std::vector<float>{0, 0, 0});
        },
    };
    for (std::size_t i = 0; i < changes.size(); ++i)
        EXPECT_NE(error_after("bad" + std::to_string(i), changes[i]), "no error") << i;
}

TEST(LabelingModelFile, MutationsNeverCrash) {
    const fs::path path = temporary("fuzz.safetensors");
    save_model(path, small_model());
    const std::string good = read_file(path);
    Random random(11);
    for (int i = 0; i < 1000; ++i) {
        std::string bytes = good.substr(0, random.uniform() < 0.3 ? random.index(good.size()) : good.size());
        for (std::size_t flips = random.index(4); flips > 0 && !bytes.empty(); --flips)
            bytes[random.index(bytes.size())] = static_cast<char>(random.next());
        write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
        try {
            load_model(path);
        } catch (const ModelError&) {
        }
    }
}

}  // namespace
}  // namespace exemplar
