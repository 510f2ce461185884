#include "gpu/imaging/canvas.h"

#include <gtest/gtest.h>

#include "gpu/runtime/vulkan/errors.h"
#include "tests/gpu/support/texels.h"

namespace exemplar {
namespace {

using test_support::shared_device;

Canvas canvas_of(std::uint32_t width, std::uint32_t height, VkFormat format = Canvas::k_rgba) {
    Canvas canvas(shared_device(), format);
    canvas.resize({width, height});
    return canvas;
}

void clear(Stream& stream, const Canvas& canvas, const std::array<float, 4>& color) {
    canvas.begin(stream);
    stream.render(Pass("clear", canvas.cleared(color)));
    canvas.end(stream);
}

TEST(CanvasDownload, IsThePictureAsItWasDrawn) {
    Canvas canvas = canvas_of(5, 3);
    Stream stream(shared_device());
    clear(stream, canvas, {1, 0.2f, 0, 1});
    canvas.record_download(stream);
    stream.finish();
    const Image image = canvas.read_image();
    ASSERT_EQ(image.width, 5);
    ASSERT_EQ(image.height, 3);
    ASSERT_EQ(image.channels, 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 5; ++x) {
            const auto pixel = image.pixel(x, y);
            EXPECT_EQ((std::array{pixel[0], pixel[1], pixel[2]}), (std::array<std::uint8_t, 3>{255, 51, 0}));
        }
}

TEST(CanvasDownload, UndoesTheProductWithAlpha) {
    Canvas canvas = canvas_of(2, 2);
    Stream stream(shared_device());
    clear(stream, canvas, {0.4f, 0.2f, 0, 0.4f});
    canvas.record_download(stream);
    stream.finish();
    const Image image = canvas.read_image(true);
    ASSERT_EQ(image.channels, 4);
    const auto pixel = image.pixel(1, 1);
    EXPECT_EQ(pixel[0], 255);
    EXPECT_NEAR(pixel[1], 128, 1);
    EXPECT_EQ(pixel[2], 0);
    EXPECT_EQ(pixel[3], 102);

    clear(stream, canvas, {0, 0, 0, 0});
    canvas.record_download(stream);
    stream.finish();
    const Image nothing = canvas.read_image(true);
    EXPECT_EQ(nothing.data, std::vector<std::uint8_t>(16, 0));
}

TEST(Canvas, HasTheSizeItWasGivenLast) {
    Canvas canvas(shared_device());
    Stream stream(shared_device());
    for (const VkExtent2D extent : {VkExtent2D{7, 2}, VkExtent2D{1, 1}, VkExtent2D{30, 41}, VkExtent2D{30, 41}}) {
        canvas.resize(extent);
        clear(stream, canvas, {0, 0, 1, 1});
        canvas.record_download(stream);
        stream.finish();
        const Image image = canvas.read_image();
        EXPECT_EQ(image.width, static_cast<int>(extent.width));
        EXPECT_EQ(image.height, static_cast<int>(extent.height));
        EXPECT_EQ(image.pixel(image.width - 1, image.height - 1)[2], 255);
    }
}

TEST(Canvas, StaysAsItIsIfItsSizeStays) {
    Canvas canvas = canvas_of(8, 8);
    const VkImage image = canvas.image();
    canvas.resize({8, 8});
    EXPECT_EQ(canvas.image(), image);
    EXPECT_THROW(canvas.resize({0, 8}), UsageError);
    EXPECT_THROW(canvas.resize({8, 1u << 30}), DeviceLimitError);
    // What went wrong left nothing half made.
    canvas.resize({8, 8});
    Stream stream(shared_device());
    clear(stream, canvas, {0, 1, 0, 1});
    for (const std::uint32_t texel : test_support::texels_of(canvas, stream)) EXPECT_EQ(texel, 0xff00ff00u);
}

TEST(Canvas, CopiesAPartOfWideColors) {
    const Canvas canvas = canvas_of(9, 6, VK_FORMAT_R16G16B16A16_SFLOAT);
    Stream stream(shared_device());
    clear(stream, canvas, {1, 0.5f, 0, 2});
    const Buffer part(shared_device(), std::size_t{8} * 4 * 3);
    canvas.copy_color(stream, {4, 3}, part);
    std::vector<std::uint16_t> halves(4 * 4 * 3);
    stream.fetch<std::uint16_t>(part, halves);
    for (std::size_t i = 0; i < halves.size(); i += 4) {
        EXPECT_EQ(halves[i], 0x3c00);
        EXPECT_EQ(halves[i + 1], 0x3800);
        EXPECT_EQ(halves[i + 2], 0);
        EXPECT_EQ(halves[i + 3], 0x4000);
    }
}

TEST(Canvas, CopiesDepths) {
    const Canvas canvas = canvas_of(4, 4);
    if (canvas.depth_format() != VK_FORMAT_D32_SFLOAT) GTEST_SKIP() << "no depths of 32 bits";
    const Buffer depths(shared_device(), 16 * sizeof(float));
    Stream stream(shared_device());
    canvas.begin(stream);
    PassTarget target = canvas.cleared({0, 0, 0, 1});
    target.clear_depth = 0.25f;
    stream.render(Pass("clear", target));
    canvas.copy_depth(stream, depths);
    std::vector<float> values(16);
    stream.fetch<float>(depths, values);
    EXPECT_EQ(values, std::vector<float>(16, 0.25f));
}

TEST(Blit, FillsThePartOfTheTargetAndScales) {
    constexpr Transition k_all{VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
                               VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                               VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT};
    const VkExtent2D extent{20, 10};
    const Canvas source = canvas_of(8, 8);
    const Attachment target(
        shared_device(), Canvas::k_rgba, extent,
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        VK_IMAGE_ASPECT_COLOR_BIT);
    Stream stream(shared_device());
    const auto change = [&](VkImageLayout from, VkImageLayout to) {
        stream.transition(target.image(), VK_IMAGE_ASPECT_COLOR_BIT, from, to, k_all);
    };
    clear(stream, source, {1, 0, 0, 1});
    change(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
    stream.render(
        Pass("clear", {.color = target.view(), .extent = extent, .clear_color = std::array<float, 4>{0, 1, 0, 1}}));
    change(VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    stream.blit(source.image(), source.extent(), target.image(), {{4, 2}, {12, 5}});
    change(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    std::vector<std::uint32_t> texels(std::size_t{extent.width} * extent.height);
    const Buffer buffer(shared_device(), 4 * texels.size());
    stream.copy_image(target.image(), VK_IMAGE_ASPECT_COLOR_BIT, extent, 4, buffer);
    stream.fetch<std::uint32_t>(buffer, texels);
    for (std::uint32_t y = 0; y < 10; ++y)
        for (std::uint32_t x = 0; x < 20; ++x) {
            const bool inside = x >= 4 && x < 16 && y >= 2 && y < 7;
            ASSERT_EQ(texels[y * 20 + x], inside ? 0xff0000ffu : 0xff00ff00u) << x << ' ' << y;
        }
}

}  // namespace
}  // namespace exemplar
