// Files of curvature models that hold more than their model needs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <ostream>

#include "host/core/errors.h"
#include "host/curvature/learning/training.h"
#include "host/data/safetensors.h"
#include "tests/support/bending_tube.h"
#include "tests/support/shapes.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Animation small_tube() {
    Animation tube = shapes::tube_rig(6, 5);
    tube.clips = {shapes::bending_clip(tube, 40, 40, 1)};
    return tube;
}

Animation small_sheet() {
    Animation sheet;
    sheet.name = "sheet";
    sheet.kind = AnimationKind::sequence;
    sheet.rest = shapes::grid(6, 6, 1);
    sheet.clips.resize(1);
    for (int i = 0; i < 40; ++i) {
        std::vector<Vec3> frame = sheet.rest.vertices;
        const float a = std::sin(0.7f * float(i)), b = std::cos(0.45f * float(i));
        for (Vec3& p : frame) p.z() = 0.05f * (a * std::sin(5 * p.x() + 2 * p.y()) + b * std::cos(6 * p.y()));
        sheet.clips[0].frames.push_back(frame);
    }
    return sheet;
}

struct SurplusCase {
    const char* name;
    Animation (*animation)();
    Learner learner;
    AttributeSet attributes;
};
void PrintTo(const SurplusCase& way, std::ostream* out) {
    *out << way.name;
}
class SurplusTest : public ::testing::TestWithParam<SurplusCase> {
  protected:
    void SetUp() override {
        const Animation animation = GetParam().animation();
        std::vector<FrameRef> frames;
        for (std::uint32_t f = 0; f < animation.clips[0].size(); ++f) frames.push_back({0, f});
        CurvatureTraining options;
        options.learner = GetParam().learner;
        options.attributes = GetParam().attributes;
        options.augmented_poses = 0;
        CurvatureTrainingReport report;
        save_curvature_model(path_, train_curvature(animation, frames, options, report));
    }

    /// Writes the file anew and requires that it is refused in the usual way.
    void expect_refused(const TensorFile& file) {
        write_safetensors(path_, file);
        try {
            load_curvature_model(path_);
            ADD_FAILURE() << "was accepted";
        } catch (const ModelError& error) {
            EXPECT_THAT(error.what(), StartsWith(path_.string() + ": damaged file: "));
            EXPECT_THAT(error.what(), ::testing::Not(HasSubstr("\n")));
        }
    }

    TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / "m.safetensors";
};

TEST_P(SurplusTest, IsRefusedAtTheEndOfEveryArray) {
    const TensorFile file = read_safetensors(path_);
    for (const auto& [name, tensor] : file.tensors) {
        if (name == "regression.monomials") continue;  // some may serve no component
        SCOPED_TRACE(name);
        Tensor longer = tensor;
        const std::size_t row = tensor.type == "F16" || tensor.type == "U16" ? 2 : 4;
        std::vector<std::uint8_t> bytes(tensor.bytes.begin(), tensor.bytes.end());
        std::size_t added = row;
        for (std::size_t i = 1; i < tensor.shape.size(); ++i) added *= tensor.shape[i];
        bytes.insert(bytes.end(), added, 0);
        ++longer.shape[0];
        longer.bytes = bytes;
        TensorFile changed = file;
        changed.tensors[name] = longer;
        expect_refused(changed);
    }
}

TEST_P(SurplusTest, IsRefusedAsAnArrayOfAnotherName) {
    TensorFile file = read_safetensors(path_);
    file.add("tiles.color", {1}, std::vector<float>{1});
    expect_refused(file);
}

TEST_P(SurplusTest, IsRefusedAsCoefficientsThatAreUsedTwice) {
    TensorFile file = read_safetensors(path_);
    std::vector<std::uint32_t> components = file.get<std::uint32_t>("regression.components");
    ASSERT_GE(components.size(), 6u);
    components[5] = components[2];
    file.add("regression.components", {components.size() / 3, 3}, components);
    expect_refused(file);
}

INSTANTIATE_TEST_SUITE_P(
    Models, SurplusTest,
    ::testing::Values(SurplusCase{"joints", small_tube, Learner::additive, AttributeSet::tensor},
                      SurplusCase{"joints_principal", small_tube, Learner::additive, AttributeSet::principal},
                      SurplusCase{"hinges", small_sheet, Learner::additive, AttributeSet::tensor},
                      SurplusCase{"hinges_principal", small_sheet, Learner::global, AttributeSet::principal},
                      SurplusCase{"local_shape", small_sheet, Learner::local, AttributeSet::tensor}),
    [](const auto& instance) { return instance.param.name; });

}  // namespace
}  // namespace exemplar
