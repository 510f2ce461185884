#include "gpu/runtime/kernel.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "embedded/tests_affine_comp.h"
#include "embedded/tests_weigh_comp.h"
#include "embedded/tests_wrong_set_comp.h"
#include "gpu/runtime/errors.h"
#include "gpu/runtime/stream.h"
#include "shaders/shared/test_kernels.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using shared::AffineParameters;
using shared::Particle;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::shared_device;

// The message of the ShaderError that making the kernel throws; empty if it throws none.
std::string shader_error(const Shader& shader, const KernelInterface& interface) {
    try {
        const Kernel kernel(shared_device(), shader, interface);
    } catch (const ShaderError& error) {
        return error.what();
    }
    return {};
}

TEST(Reflection, ReadsTheInterface) {
    const Reflection weigh = reflect(shaders::tests_weigh_comp);
    ASSERT_EQ(weigh.bindings.size(), 2u);
    EXPECT_EQ(weigh.bindings[0].binding, 0u);
    EXPECT_EQ(weigh.bindings[0].stride, sizeof(Particle));
    EXPECT_EQ(weigh.bindings[0].fields.size(), 4u);
    EXPECT_TRUE(weigh.bindings[0].reads && !weigh.bindings[0].writes);
    EXPECT_EQ(weigh.bindings[1].binding, 2u);
    EXPECT_TRUE(!weigh.bindings[1].reads && weigh.bindings[1].writes);
    EXPECT_EQ(weigh.push_bytes, 0u);
    EXPECT_THAT(weigh.local_size, ::testing::ElementsAre(32, 1, 1));

    const Reflection affine = reflect(shaders::tests_affine_comp);
    EXPECT_EQ(affine.push_bytes, sizeof(AffineParameters));
    EXPECT_EQ(affine.local_size_ids[0], 0u);
    EXPECT_TRUE(affine.bindings.at(0).reads && affine.bindings.at(0).writes);
}

TEST(Reflection, RefusesDamagedModules) {
    const std::vector<std::uint32_t> words = {0x07230203u, 0x00010500u, 0u};
    EXPECT_THROW(reflect({"damaged", words}), ShaderError);
    EXPECT_THROW(reflect({"empty", {}}), ShaderError);
}

TEST(Kernel, RunsWithSharedStructuresAndConstants) {
    const Kernel kernel(shared_device(), shaders::tests_weigh_comp,
                        {.elements = {layout_of<Particle>(), layout_of<float>()},
                         .constants = {{3, std::bit_cast<std::uint32_t>(0.25f)}}});
    std::vector<Particle> particles(33);
    for (std::size_t i = 0; i < particles.size(); ++i)
        particles[i] = {.position = {1.0f, 2.0f, 3.0f, static_cast<float>(i)},
                        .mass = 2.0f,
                        .id = static_cast<std::uint32_t>(i),
                        .padding = {}};
    const Buffer input = Buffer::of<Particle>(shared_device(), particles);
    Buffer output(shared_device(), particles.size() * sizeof(float));
    Stream stream(shared_device());
    stream.dispatch(kernel, particles.size(), {input, output});
    stream.finish();
    std::vector<float> weights(particles.size());
    output.download<float>(weights);
    for (std::size_t i = 0; i < weights.size(); ++i) EXPECT_EQ(weights[i], 12.25f + 3.0f * static_cast<float>(i));
}

TEST(Kernel, RefusesOtherPushConstants) {
    EXPECT_EQ(shader_error(shaders::tests_affine_comp, {.push_constants = layout_of<AffineParameters>()}), "");
    StructLayout renamed = layout_of<AffineParameters>();
    renamed.fields[1].name = "slope";
    EXPECT_THAT(shader_error(shaders::tests_affine_comp, {.push_constants = renamed}),
                AllOf(HasSubstr("tests/affine.comp"), HasSubstr("AffineParameters"), HasSubstr("'factor'"),
                      HasSubstr("'slope'")));
    StructLayout longer = layout_of<AffineParameters>();
    longer.bytes += 4;
    longer.fields.push_back({"extra", 12, 4});
    EXPECT_THAT(shader_error(shaders::tests_affine_comp, {.push_constants = longer}),
                HasSubstr("3 members there and 4 here"));
    EXPECT_THAT(shader_error(shaders::tests_affine_comp, {}), HasSubstr("12 bytes there and 0 here"));
    EXPECT_THAT(shader_error(shaders::tests_weigh_comp, {.push_constants = layout_of<AffineParameters>()}),
                HasSubstr("push constants"));
}

TEST(Kernel, RefusesOtherElements) {
    StructLayout moved = layout_of<Particle>();
    std::swap(moved.fields[1].offset, moved.fields[2].offset);
    EXPECT_THAT(shader_error(shaders::tests_weigh_comp, {.elements = {moved}}),
                AllOf(HasSubstr("'Particles'"), HasSubstr("'mass' is at byte 16 there and at byte 20 here")));
    StructLayout wide = layout_of<Particle>();
    wide.fields[0].bytes = 12;
    EXPECT_THAT(shader_error(shaders::tests_weigh_comp, {.elements = {wide}}), HasSubstr("16 bytes there and 12 here"));
    EXPECT_THAT(shader_error(shaders::tests_weigh_comp, {.elements = {layout_of<Particle>(), layout_of<double>()}}),
                HasSubstr("4 bytes there and 8 here"));
    EXPECT_THAT(shader_error(shaders::tests_weigh_comp,
                             {.elements = {layout_of<Particle>(), layout_of<float>(), layout_of<float>()}}),
                HasSubstr("2 storage buffers"));
}

TEST(Kernel, RefusesUnknownConstantsAndOtherSets) {
    EXPECT_THAT(shader_error(shaders::tests_weigh_comp, {.constants = {{4, 0}}}),
                HasSubstr("no specialization constant 4"));
    EXPECT_THAT(shader_error(shaders::tests_wrong_set_comp, {}), HasSubstr("descriptor set 0"));
}

TEST(Kernel, RefusesWorkgroupsOverTheLimit) {
    const std::uint32_t limit = shared_device().info().max_invocations;
    try {
        const Kernel kernel(shared_device(), shaders::tests_affine_comp,
                            {.push_constants = layout_of<AffineParameters>(), .constants = {{0, limit + 1}}});
        FAIL() << "no error";
    } catch (const DeviceLimitError& error) {
        EXPECT_EQ(error.requested, limit + 1u);
        EXPECT_EQ(error.limit, limit);
    }
    EXPECT_THROW(Kernel(shared_device(), shaders::tests_affine_comp,
                        {.push_constants = layout_of<AffineParameters>(), .constants = {{0, 0}}}),
                 ShaderError);
}

}  // namespace
}  // namespace exemplar
