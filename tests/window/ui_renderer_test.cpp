#include "gpu/window/ui_renderer.h"

#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>

#include "gpu/runtime/vulkan/errors.h"
#include "tests/gpu/support/texels.h"

namespace exemplar {
namespace {

using test_support::shared_device;

constexpr std::uint32_t k_width = 60, k_height = 40;

class Interface : public ::testing::Test {
  protected:
    Interface() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr;
        ImGui::GetIO().DisplaySize = ImVec2(k_width, k_height);
    }
    ~Interface() override { ImGui::DestroyContext(); }

    // What is drawn over blue, on a canvas of `scale` pixels per unit.
    template <typename Draw>
    std::vector<std::uint32_t> draw(Draw&& draw_shapes, std::uint32_t scale = 1) {
        ImGui::GetIO().DisplayFramebufferScale = ImVec2(static_cast<float>(scale), static_cast<float>(scale));
        UiRenderer renderer(shared_device(), Canvas::k_rgba, *ImGui::GetIO().Fonts);
        ImGui::NewFrame();
        draw_shapes(*ImGui::GetBackgroundDrawList());
        ImGui::Render();
        Canvas canvas(shared_device());
        canvas.resize({scale * k_width, scale * k_height});
        return test_support::drawn_texels(canvas, {0, 0, 1, 1}, [&](Stream& stream) {
            renderer.record(stream, *ImGui::GetDrawData(), canvas.color_view(), canvas.extent());
        });
    }
};

int channel(std::uint32_t texel, int c) {
    return static_cast<int>(texel >> (8 * c) & 0xff);
}

TEST_F(Interface, FillsExactlyTheRectangleThatIsAskedFor) {
    const auto texels = draw([](ImDrawList& list) {
        list.Flags = 0;  // no soft edges
        list.AddRectFilled(ImVec2(10, 5), ImVec2(30, 20), IM_COL32(255, 128, 0, 255));
    });
    for (std::uint32_t y = 0; y < k_height; ++y)
        for (std::uint32_t x = 0; x < k_width; ++x) {
            const bool inside = x >= 10 && x < 30 && y >= 5 && y < 20;
            ASSERT_EQ(texels[y * k_width + x] & 0xffffff, inside ? 0x0080ffu : 0xff0000u) << x << ' ' << y;
        }
}

TEST_F(Interface, LetsWhatIsBehindShineThrough) {
    const auto texels =
        draw([](ImDrawList& list) { list.AddRectFilled(ImVec2(0, 0), ImVec2(60, 40), IM_COL32(255, 0, 0, 64)); });
    const std::uint32_t texel = texels[20 * k_width + 30];
    EXPECT_NEAR(channel(texel, 0), 64, 1);
    EXPECT_NEAR(channel(texel, 2), 191, 1);
}

TEST_F(Interface, ClipsToTheRectangleOfTheCommandAtEveryScale) {
    for (const std::uint32_t scale : {1u, 2u}) {
        const auto texels = draw(
            [](ImDrawList& list) {
                list.Flags = 0;
                list.PushClipRect(ImVec2(20, 10), ImVec2(40, 30));
                list.AddRectFilled(ImVec2(-100, -100), ImVec2(400, 400), IM_COL32(255, 255, 255, 255));
                list.PopClipRect();
            },
            scale);
        const auto count = static_cast<std::uint32_t>(std::count(texels.begin(), texels.end(), 0xffffffffu));
        EXPECT_EQ(count, 20 * 20 * scale * scale);
    }
}

TEST_F(Interface, DrawsTextAsTheAtlasHasIt) {
    unsigned char* alpha = nullptr;
    int width = 0, height = 0;
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.GetTexDataAsAlpha8(&alpha, &width, &height);
    const std::vector<unsigned char> pixels(alpha, alpha + width * height);
    const ImFontGlyph glyph = *atlas.Fonts[0]->FindGlyph('R');
    const auto texels = draw([](ImDrawList& list) { list.AddText(ImVec2(8, 8), IM_COL32(255, 255, 255, 255), "R"); });
    int opaque = 0;
    for (int y = 0; y < static_cast<int>(glyph.Y1 - glyph.Y0); ++y)
        for (int x = 0; x < static_cast<int>(glyph.X1 - glyph.X0); ++x) {
            const int at_x = static_cast<int>(std::lround(glyph.U0 * static_cast<float>(width))) + x,
                      at_y = static_cast<int>(std::lround(glyph.V0 * static_cast<float>(height))) + y;
            const int expected = pixels[static_cast<std::size_t>(at_y) * static_cast<std::size_t>(width) +
                                        static_cast<std::size_t>(at_x)];
            const auto place = (8 + static_cast<std::size_t>(glyph.Y0) + static_cast<std::size_t>(y)) * k_width + 8 +
                               static_cast<std::size_t>(glyph.X0) + static_cast<std::size_t>(x);
            EXPECT_NEAR(channel(texels[place], 0), expected, 1);
            opaque += expected > 128;
        }
    EXPECT_GT(opaque, 10);
}

TEST_F(Interface, ManyTrianglesNeedNoOtherIndices) {
    const auto texels = draw([](ImDrawList& list) {
        list.Flags = 0;
        for (int i = 0; i < 12000; ++i) list.AddRectFilled(ImVec2(0, 0), ImVec2(1, 1), IM_COL32(1, 1, 1, 255));
        list.AddRectFilled(ImVec2(50, 30), ImVec2(60, 40), IM_COL32(0, 255, 0, 255));
    });
    EXPECT_EQ(texels[0], 0xff010101u);
    EXPECT_EQ(texels[35 * k_width + 55], 0xff00ff00u);
}

TEST_F(Interface, NothingIsDrawnWithoutShapesOrPixels) {
    const auto texels = draw([](ImDrawList&) {});
    EXPECT_EQ(texels[0], 0xffff0000u);
}

TEST_F(Interface, ShowsPicturesWithTheirColors) {
    ImGui::GetIO().DisplayFramebufferScale = ImVec2(1, 1);
    UiRenderer renderer(shared_device(), Canvas::k_rgba, *ImGui::GetIO().Fonts);
    const std::vector<std::uint32_t> picture{0xff0000ff, 0xff00ff00, 0xffff0000, 0xff808080};  // 2 x 2
    renderer.set_pictures(picture, 2, 2);
    EXPECT_THROW(renderer.set_pictures(picture, 3, 2), UsageError);
    ImGui::NewFrame();
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddImage(picture_texture(), ImVec2(10, 10), ImVec2(30, 30));
    list.AddRectFilled(ImVec2(40, 10), ImVec2(50, 20), IM_COL32(255, 255, 255, 255));  // with the font atlas again
    ImGui::Render();
    Canvas canvas(shared_device());
    canvas.resize({k_width, k_height});
    const auto texels = test_support::drawn_texels(canvas, {0, 0, 1, 1}, [&](Stream& stream) {
        renderer.record(stream, *ImGui::GetDrawData(), canvas.color_view(), canvas.extent());
    });
    const auto at = [&](std::uint32_t x, std::uint32_t y) { return texels[y * k_width + x] & 0xffffff; };
    EXPECT_EQ(at(12, 12), 0x0000ffu);
    EXPECT_EQ(at(28, 12), 0x00ff00u);
    EXPECT_EQ(at(12, 28), 0xff0000u);
    EXPECT_EQ(at(28, 28), 0x808080u);
    EXPECT_EQ(at(45, 15), 0xffffffu);
    EXPECT_EQ(at(35, 15), 0xff0000u) << "the background";
}

}  // namespace
}  // namespace exemplar
