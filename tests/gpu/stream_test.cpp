#include "gpu/runtime/record/stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "embedded/tests_affine_comp.h"
#include "embedded/tests_weigh_comp.h"
#include "gpu/runtime/vulkan/errors.h"
#include "shaders/shared/test_kernels.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using shared::AffineParameters;
using test_support::shared_device;

Kernel affine_kernel(std::uint32_t local_size = 64) {
    return Kernel(shared_device(), shaders::tests_affine_comp,
                  {.push_constants = layout_of<AffineParameters>(),
                   .elements = {layout_of<float>()},
                   .constants = {{0, local_size}}});
}

std::vector<float> iota(std::size_t count) {
    std::vector<float> values(count);
    std::iota(values.begin(), values.end(), 0.0f);
    return values;
}

TEST(Stream, DispatchesOnOddSizes) {
    const Kernel kernel = affine_kernel();
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
        std::vector<float> values = iota(count);
        Buffer buffer = Buffer::of<float>(shared_device(), values);
        Stream stream(shared_device());
        stream.dispatch(kernel, count, {buffer}, AffineParameters{static_cast<std::uint32_t>(count), 2.0f, 1.0f});
        stream.download<float>(buffer, values);
        stream.finish();
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(values[i], 2.0f * static_cast<float>(i) + 1.0f);
    }
}

// 65,535 groups are all that one dimension must hold; with one invocation per group a plain count goes beyond it.
TEST(Stream, FoldsManyGroups) {
    const Kernel kernel = affine_kernel(1);
    for (const std::size_t count : {65535u, 65536u, 200003u}) {
        std::vector<float> values(count, 1.0f);
        Buffer buffer = Buffer::of<float>(shared_device(), values);
        Stream stream(shared_device());
        stream.dispatch(kernel, count, {buffer}, AffineParameters{static_cast<std::uint32_t>(count), 1.0f, 1.0f});
        stream.finish();
        buffer.download<float>(values);
        EXPECT_EQ(std::count(values.begin(), values.end(), 2.0f), static_cast<std::ptrdiff_t>(count));
    }
}

// Each dispatch reads what the one before wrote; without barriers a parallel device would mix them up.
TEST(Stream, RepeatsOneKernelOnOneBufferInOrder) {
    constexpr std::size_t k_count = 100'000;
    const Kernel kernel = affine_kernel();
    std::vector<float> values(k_count, 1.0f);
    Buffer buffer = Buffer::of<float>(shared_device(), values);
    Stream stream(shared_device());
    float expected = 1.0f;
    for (int i = 0; i < 40; ++i) {
        const float factor = i % 2 ? 0.5f : 2.0f;
        stream.dispatch(kernel, k_count, {buffer}, AffineParameters{k_count, factor, 1.0f});
        expected = expected * factor + 1.0f;
    }
    EXPECT_EQ(stream.barriers().size(), 39u);
    stream.download<float>(buffer, values);
    stream.finish();
    for (const float value : values) ASSERT_EQ(value, expected);
}

TEST(Stream, SeesWhatEarlierStreamsWrote) {
    constexpr std::size_t k_count = 50'000;
    const Kernel kernel = affine_kernel();
    Buffer buffer(shared_device(), k_count * sizeof(float));
    Stream first(shared_device()), second(shared_device());
    first.fill(buffer, 0);
    first.dispatch(kernel, k_count, {buffer}, AffineParameters{k_count, 1.0f, 3.0f});
    second.dispatch(kernel, k_count, {buffer}, AffineParameters{k_count, 2.0f, 0.0f});
    first.submit();
    second.submit();
    std::vector<float> values(k_count);
    buffer.download<float>(values);
    for (const float value : values) ASSERT_EQ(value, 6.0f);
    first.wait();
    second.wait();
}

TEST(Stream, UploadsCopiesAndDownloadsInRecordedOrder) {
    const Kernel kernel = affine_kernel();
    Buffer a(shared_device(), 8 * sizeof(float)), b(shared_device(), 8 * sizeof(float));
    std::vector<float> before(8), after(8), copied(4);
    Stream stream(shared_device());
    stream.upload<float>(a, iota(8));
    stream.dispatch(kernel, 8, {a}, AffineParameters{8, 1.0f, 10.0f});
    stream.download<float>(a, before);
    stream.upload<float>(a, std::vector<float>{-1.0f, -2.0f}, 4 * sizeof(float));
    stream.copy(a, 2 * sizeof(float), b, 0, 4 * sizeof(float));
    stream.dispatch(kernel, 8, {a}, AffineParameters{8, 0.0f, 5.0f});
    stream.download<float>(a, after);
    stream.download<float>(b, copied);
    stream.finish();
    EXPECT_THAT(before, ::testing::ElementsAre(10, 11, 12, 13, 14, 15, 16, 17));
    EXPECT_THAT(copied, ::testing::ElementsAre(12, 13, -1, -2));
    EXPECT_THAT(after, ::testing::Each(5.0f));
}

TEST(Stream, KeepsBuffersAndKernelsAliveUntilDone) {
    std::vector<float> values(1000, 1.0f);
    Stream stream(shared_device());
    {
        const Kernel kernel = affine_kernel();
        Buffer buffer = Buffer::of<float>(shared_device(), values);
        stream.dispatch(kernel, 1000, {buffer}, AffineParameters{1000, 1.0f, 1.0f});
        stream.download<float>(buffer, values);
    }
    stream.finish();
    EXPECT_THAT(values, ::testing::Each(2.0f));
}

TEST(Stream, DispatchesMoreThanADescriptorPoolHolds) {
    const Kernel kernel = affine_kernel();
    const std::size_t step = std::max<std::size_t>(shared_device().info().storage_alignment, sizeof(float));
    Buffer buffer = Buffer::of<float>(shared_device(), std::vector<float>(600 * step / sizeof(float)));
    Stream stream(shared_device());
    for (int round = 0; round < 2; ++round) {
        for (std::size_t i = 0; i < 600; ++i)  // another set each
            stream.dispatch(kernel, 1, {BufferRange(buffer, i * step, sizeof(float))}, AffineParameters{1, 1.0f, 1.0f});
        stream.finish();
    }
    std::vector<float> values(600 * step / sizeof(float));
    buffer.download<float>(values);
    for (std::size_t i = 0; i < 600; ++i) EXPECT_EQ(values[i * step / sizeof(float)], 2.0f);
}

TEST(Stream, BindsRangesOfABuffer) {
    const std::size_t alignment = shared_device().info().storage_alignment;
    const std::size_t floats = std::max<std::size_t>(alignment, 16) / sizeof(float);
    std::vector<float> values(3 * floats, 1.0f);
    Buffer buffer = Buffer::of<float>(shared_device(), values);
    const Kernel kernel = affine_kernel();
    const auto count = static_cast<std::uint32_t>(floats);
    Stream stream(shared_device());
    stream.dispatch(kernel, floats, {BufferRange(buffer, floats * sizeof(float), floats * sizeof(float))},
                    AffineParameters{count, 1.0f, 1.0f});
    stream.fetch<float>(buffer, values);
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(values[i], i / floats == 1 ? 2.0f : 1.0f);
}

TEST(Stream, EmptyRangesAreBoundAnywhere) {
    const Kernel kernel = affine_kernel();
    Buffer buffer(shared_device(), 1024), empty(shared_device(), 0);
    Stream stream(shared_device());
    stream.dispatch(kernel, 1, {BufferRange(buffer, 1024, 0)}, AffineParameters{0, 1.0f, 0.0f});
    stream.dispatch(kernel, 1, {BufferRange(buffer, 0, 0)}, AffineParameters{0, 1.0f, 0.0f});
    stream.dispatch(kernel, 1, {empty}, AffineParameters{0, 1.0f, 0.0f});
    EXPECT_NO_THROW(stream.finish());
}

TEST(Stream, CopiesWithinABufferUnlessTheyOverlap) {
    Buffer buffer = Buffer::of<float>(shared_device(), iota(8));
    Stream stream(shared_device());
    stream.copy(buffer, 0, buffer, 16, 16);
    EXPECT_THROW(stream.copy(buffer, 0, buffer, 12, 16), DeviceError);
    EXPECT_THROW(stream.copy(buffer, 12, buffer, 0, 16), DeviceError);
    stream.finish();
    std::vector<float> values(8);
    buffer.download<float>(values);
    EXPECT_THAT(values, ::testing::ElementsAre(0, 1, 2, 3, 0, 1, 2, 3));
}

TEST(Stream, UploadsWhatIsComputedOnTheWay) {
    Buffer buffer(shared_device(), 16);
    Stream stream(shared_device());
    for (const std::byte value : {std::byte{1}, std::byte{2}})  // first into the buffer itself where it is mapped
        stream.upload_with(buffer, 8, 8, [&](std::span<std::byte> memory) { std::ranges::fill(memory, value); });
    stream.fill(buffer, 0);
    stream.upload_with(buffer, 4, 4, [](std::span<std::byte> memory) { std::ranges::fill(memory, std::byte{3}); });
    stream.finish();
    std::vector<std::uint32_t> words(4);
    buffer.download<std::uint32_t>(words);
    EXPECT_THAT(words, ::testing::ElementsAre(0, 0x03030303u, 0, 0));
}

TEST(Stream, FetchesPartsOfABuffer) {
    const Buffer buffer = Buffer::of<float>(shared_device(), iota(8));
    std::vector<float> first(2), second(3);
    Stream stream(shared_device());
    const auto part = [](std::size_t from, std::vector<float>& to) {
        return HostReadback{from * sizeof(float), std::as_writable_bytes(std::span(to))};
    };
    stream.fetch(buffer, std::vector<HostReadback>{part(5, first), part(1, second)});
    EXPECT_THAT(first, ::testing::ElementsAre(5, 6));
    EXPECT_THAT(second, ::testing::ElementsAre(1, 2, 3));
    EXPECT_THROW(stream.fetch(buffer, std::vector<HostReadback>{part(0, first), part(6, second)}), DeviceError);
}

TEST(Stream, FetchesPartsOfSeveralBuffersByOneSubmission) {
    Profiler profiler;
    Stream stream(shared_device(), &profiler);
    Buffer one(shared_device(), 32), two(shared_device(), 32), three(shared_device(), 32);
    for (Buffer* buffer : {&one, &two, &three}) buffer->upload<float>(iota(8));
    std::vector<float> got(7, -1.0f);
    const auto part = [&](const Buffer& source, std::size_t from, std::size_t first, std::size_t count) {
        return BufferReadback{&source, from * sizeof(float),
                              std::as_writable_bytes(std::span(got).subspan(first, count))};
    };
    stream.copy(one, 0, two, 16, 16);
    stream.fetch(std::vector<BufferReadback>{part(one, 6, 0, 2), part(two, 3, 2, 3), part(three, 5, 5, 1)});
    EXPECT_THAT(got, ::testing::ElementsAre(6, 7, 3, 0, 1, 5, -1));
    EXPECT_EQ(profiler.submissions(), 1u);
    EXPECT_THROW(stream.fetch(std::vector<BufferReadback>{part(one, 0, 0, 1), part(two, 7, 1, 2)}), DeviceError);
    profiler.reset();
    EXPECT_EQ(profiler.submissions(), 0u);
}

TEST(Stream, RefusesWrongArguments) {
    const Kernel kernel = affine_kernel();
    Buffer buffer(shared_device(), 4096);
    Stream stream(shared_device());
    EXPECT_THROW(stream.dispatch(kernel, 1, {buffer, buffer}, AffineParameters{}), ShaderError);
    EXPECT_THROW(stream.dispatch(kernel, 1, {buffer}), ShaderError);
    EXPECT_THROW(stream.dispatch(kernel, 1, {Buffer()}, AffineParameters{}), ShaderError);
    EXPECT_THROW(stream.dispatch(kernel, 1, {BufferRange(buffer, 0, 8192)}, AffineParameters{}), ShaderError);
    EXPECT_THROW(stream.dispatch(kernel, 1, {BufferRange(buffer, 1, 4)}, AffineParameters{}), DeviceLimitError);
    for (const std::uint64_t threads : {std::uint64_t{1} << 33, ~std::uint64_t{0}})
        EXPECT_THROW(stream.dispatch(kernel, threads, {buffer}, AffineParameters{}), DeviceLimitError);
    EXPECT_THROW(stream.copy(buffer, 4000, buffer, 0, 100), DeviceError);
    std::vector<float> more(buffer.bytes() / sizeof(float) + 1);
    EXPECT_THROW(stream.fetch<float>(buffer, more), DeviceError);
    stream.finish();
}

TEST(Stream, RefusesRecordingBeforeWaiting) {
    const Kernel kernel = affine_kernel();
    Buffer buffer(shared_device(), 64);
    Stream stream(shared_device());
    stream.fill(buffer, 0);
    stream.submit();
    EXPECT_THROW(stream.fill(buffer, 1), DeviceError);
    stream.wait();
}

TEST(Profiler, TimesEveryDispatch) {
    if (shared_device().info().timestamp_period == 0.0f) GTEST_SKIP() << "the device has no timestamps";
    Profiler profiler;
    const Kernel kernel = affine_kernel();
    Buffer buffer(shared_device(), 4 << 20);
    Stream stream(shared_device(), &profiler);
    for (int i = 0; i < 3; ++i) stream.dispatch(kernel, 1 << 20, {buffer}, AffineParameters{1 << 20, 1.0f, 1.0f});
    stream.finish();
    ASSERT_EQ(profiler.entries().size(), 1u);
    EXPECT_EQ(profiler.entries().begin()->first, "tests/affine.comp");
    EXPECT_EQ(profiler.entries().begin()->second.dispatches, 3u);
    EXPECT_GT(profiler.milliseconds("tests/affine.comp"), 0.0);
    EXPECT_LT(profiler.milliseconds("tests/affine.comp"), 60'000.0);
    EXPECT_EQ(profiler.milliseconds("other"), 0.0);
    // More than a query pool holds, and again in the next submission.
    for (int i = 0; i < 1100; ++i) stream.dispatch(kernel, 1, {buffer}, AffineParameters{1, 1.0f, 1.0f});
    stream.finish();
    EXPECT_EQ(profiler.entries().begin()->second.dispatches, 1103u);
}

}  // namespace
}  // namespace exemplar
