#include "gpu/runtime/kernels/kernel.h"
#include "embedded/imaging_unpack_comp.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <vector>

#include "embedded/imaging_unpack_comp.h"
#include "embedded/tests_affine_comp.h"
#include "embedded/tests_gather_comp.h"
#include "embedded/tests_weigh_comp.h"
#include "embedded/tests_wrong_set_comp.h"
#include "gpu/runtime/record/stream.h"
#include "gpu/runtime/vulkan/errors.h"
#include "shaders/shared/image_filters.h"
#include "shaders/shared/test_kernels.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using shared::AffineParameters;
using shared::Particle;
using test_support::shared_device;
using ::testing::AllOf;
using ::testing::HasSubstr;

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

TEST(Reflection, ReadsTexelBuffers) {
    const Reflection gather = reflect(shaders::tests_gather_comp);
    ASSERT_EQ(gather.bindings.size(), 3u);
    EXPECT_TRUE(gather.bindings[0].type == BindingType::texels && gather.bindings[0].integers);
    EXPECT_TRUE(gather.bindings[1].type == BindingType::texels && !gather.bindings[1].integers);
    EXPECT_TRUE(gather.bindings[1].reads && !gather.bindings[1].writes);
    EXPECT_EQ(gather.bindings[2].type, BindingType::storage);
}

TEST(Reflection, RefusesDamagedModules) {
    const std::vector<std::uint32_t> words = {0x07230203u, 0x00010500u, 0u};
    EXPECT_THROW(reflect({"damaged", words, words}), ShaderError);
    EXPECT_THROW(reflect({"empty", {}, {}}), ShaderError);
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

TEST(Kernel, ReadsTexelsOfTheirCppTypes) {
    const Kernel kernel(shared_device(), shaders::tests_gather_comp,
                        {.elements = {layout_of<std::uint32_t>(), layout_of<shared::vec4>()}});
    EXPECT_EQ(kernel.reflection().bindings[0].format, VK_FORMAT_R32_UINT);
    EXPECT_EQ(kernel.reflection().bindings[1].format, VK_FORMAT_R32G32B32A32_SFLOAT);
    constexpr std::size_t k_count = 36;  // fills whole vec4s: the shader asks for the length
    std::vector<shared::vec4> vectors(17);
    std::vector<std::uint32_t> indices(k_count);
    for (std::size_t i = 0; i < vectors.size(); ++i) vectors[i] = {static_cast<float>(i), 1.0f, 2.0f, 3.0f};
    for (std::size_t i = 0; i < k_count; ++i) indices[i] = static_cast<std::uint32_t>(5 * i % vectors.size());
    // The vectors are the tail of their buffer.
    const std::size_t front = std::max<std::size_t>(shared_device().info().texel_alignment, 16);
    Buffer input(shared_device(), front + vectors.size() * sizeof(shared::vec4));
    input.upload<shared::vec4>(vectors, front);
    const Buffer places = Buffer::of<std::uint32_t>(shared_device(), indices);
    Buffer output(shared_device(), k_count * sizeof(float));
    Stream stream(shared_device());
    // Written and read as texels in one stream: the barrier is for sampled reads.
    stream.copy(input, front, input, 0, sizeof(shared::vec4));
    stream.dispatch(kernel, k_count,
                    {places, BufferRange(input, front, vectors.size() * sizeof(shared::vec4)), output});
    stream.finish();
    ASSERT_EQ(stream.barriers().size(), 1u);
    EXPECT_EQ(stream.barriers()[0].target_access, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT);
    std::vector<float> sums(k_count);
    output.download<float>(sums);
    for (std::size_t i = 0; i < k_count; ++i) EXPECT_EQ(sums[i], 6.0f + static_cast<float>(indices[i])) << i;
}

TEST(Kernel, RefusesTexelsWithoutAFormat) {
    EXPECT_THAT(shader_error(shaders::tests_gather_comp, {}),
                AllOf(HasSubstr("'indices'"), HasSubstr("4 or 16 bytes")));
    EXPECT_THAT(
        shader_error(shaders::tests_gather_comp, {.elements = {layout_of<std::uint32_t>(), layout_of<shared::vec2>()}}),
        AllOf(HasSubstr("'vectors'"), HasSubstr("not 8")));
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
                HasSubstr("it has 2 buffers"));
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
    // Every device allows some workgroup, and only so many invocations along one axis.
    EXPECT_LE(shared_device().info().max_group_size[0], limit);
    EXPECT_THROW(Kernel(shared_device(), shaders::tests_affine_comp,
                        {.push_constants = layout_of<AffineParameters>(), .constants = {{0, 0}}}),
                 ShaderError);
}

Kernel unpacking() {
    return {shared_device(),
            shaders::imaging_unpack_comp,
            {.push_constants = layout_of<shared::ImageParameters>(), .elements = {layout_of<shared::vec4>()}}};
}

TEST(KernelTest, GroupSizesComeFromTheTuning) {
    Device& device = shared_device();
    const Tuning kept = device.tuning();
    device.tuning() = {};
    EXPECT_EQ(unpacking().local_size()[0], 64u);
    device.tuning().set("imaging/unpack.comp", "group", 128);
    EXPECT_EQ(unpacking().local_size()[0], 128u);
    // No possible size.
    device.tuning().set("imaging/unpack.comp", "group", 77);
    EXPECT_EQ(unpacking().local_size()[0], 64u);
    // More than some devices allow: never more than this one does.
    device.tuning().set("imaging/unpack.comp", "group", 512);
    EXPECT_LE(unpacking().local_size()[0], device.info().max_invocations);
    device.tuning() = kept;
}

}  // namespace
}  // namespace exemplar
