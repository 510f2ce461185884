#include "gpu/imaging/surface_painter.h"

#include <gtest/gtest.h>

#include <set>

#include "host/imaging/raster.h"
#include "tests/gpu/support/texels.h"

namespace exemplar {
namespace {

using shared::uvec4;
using shared::vec4;
using test_support::shared_device;

constexpr std::uint32_t k_size = 48;

// Two triangles that fill the view of a parallel camera along -z, with what gpu/curvature would say of them.
class SurfacePainting : public ::testing::Test {
  protected:
    std::vector<std::uint32_t> draw(const PaintLook& look) {
        Device& device = shared_device();
        SurfacePainter painter(device, Canvas::k_rgba, depth_format(device));
        const Buffer faces = Buffer::of<uvec4>(device, std::vector<uvec4>{{0, 1, 2, 0}, {0, 2, 3, 0}});
        const Buffer indices = Buffer::of<std::uint32_t>(device, std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3});
        const Buffer vertices =
            Buffer::of<vec4>(device, std::vector<vec4>{{-1, -1, 0, 1}, {1, -1, 0, 1}, {1, 1, 0, 1}, {-1, 1, 0, 1}});
        const Buffer normals = Buffer::of<vec4>(device, std::vector<vec4>(4, normal_));
        const Buffer colors = Buffer::of<std::uint32_t>(device, std::vector<std::uint32_t>{0x0000ff, 0x00ff00});
        const Buffer first = Buffer::of<vec4>(device, std::vector<vec4>(4, {1, 0, 0, k1_}));
        const Buffer second = Buffer::of<vec4>(device, std::vector<vec4>(4, {0, 1, 0, k2_}));
        Camera camera;
        camera.view = look_at(Vec3(0, 0, 2), Vec3::Zero());
        camera.projection = orthographic(half_height_, 1, 1, 3);
        Canvas canvas(device);
        canvas.resize({k_size, k_size});
        const PaintedSurface surface{.face_count = 2,
                                     .faces = &faces,
                                     .indices = by_corner_ ? nullptr : &indices,
                                     .vertices = &vertices,
                                     .normals = &normals,
                                     .colors = colored_ ? &colors : nullptr,
                                     .first = curved_ ? &first : nullptr,
                                     .second = curved_ ? &second : nullptr};
        return test_support::drawn_texels(canvas, {0, 0, 0, 1}, [&](Stream& stream) {
            Pass pass("surface", canvas.cleared(background_of(look)));
            painter.draw(pass, surface, camera, look);
            stream.render(pass);
        });
    }
    std::uint32_t middle(const PaintLook& look) { return draw(look)[(k_size / 2 + 4) * k_size + k_size / 2]; }

    vec4 normal_{0, 0, 1, 0};
    float k1_ = 0, k2_ = 0, half_height_ = 1;
    bool by_corner_ = false, colored_ = true, curved_ = true;
};

int red(std::uint32_t texel) {
    return static_cast<int>(texel & 0xff);
}
int blue(std::uint32_t texel) {
    return static_cast<int>(texel >> 16 & 0xff);
}

TEST_F(SurfacePainting, UnlitColorsAreTakenAsTheyAre) {
    const std::uint32_t texel = middle({.light = SurfaceLight::none, .plain = {10, 130, 250}});
    EXPECT_NEAR(red(texel), 10, 1);
    EXPECT_NEAR(blue(texel), 250, 1);
    for (const std::uint32_t t : draw({.light = SurfaceLight::none})) EXPECT_NE(t, 0xff000000u);
}

TEST_F(SurfacePainting, FacesHaveTheirColors) {
    const auto texels = draw({.paint = SurfacePaint::faces, .light = SurfaceLight::none});
    EXPECT_EQ(texels[40 * k_size + 44] & 0xffffff, 0x0000ffu);
    EXPECT_EQ(texels[4 * k_size + 3] & 0xffffff, 0x00ff00u);
}

TEST_F(SurfacePainting, LightIsThatOfTheReference) {
    const RenderOptions light;
    const float expected =
        linear_to_srgb(srgb_to_linear(0.5f) * (light.ambient * (light.ground + 1) / 2 + light.headlight));
    const Color gray{128, 128, 128};
    const std::uint32_t smooth = middle({.plain = gray});
    EXPECT_NEAR(red(smooth), 255 * expected, 2);
    EXPECT_EQ(middle({.light = SurfaceLight::flat, .plain = gray}), smooth);
    normal_ = {0, 0, -1, 0};  // surfaces have two sides
    EXPECT_EQ(middle({.plain = gray}), smooth);
    normal_ = {0, 0, 0, 0};
    EXPECT_EQ(middle({.plain = gray}) >> 24, 0xffu);
}

TEST_F(SurfacePainting, ConvexIsRedAndHollowIsBlue) {
    PaintLook look{.paint = SurfacePaint::mean_curvature, .light = SurfaceLight::none, .full_color_curvature = 4};
    const std::uint32_t flat = middle(look);
    EXPECT_EQ(red(flat), blue(flat));
    k1_ = 3;
    k2_ = 1;
    const std::uint32_t convex = middle(look);
    EXPECT_GT(red(convex), blue(convex) + 30);
    std::swap(k1_, k2_);
    EXPECT_EQ(middle(look), convex);  // of both
    k1_ = -3;
    k2_ = -1;
    const std::uint32_t hollow = middle(look);
    EXPECT_GT(blue(hollow), red(hollow) + 30);
    k1_ = 5;
    k2_ = -5;
    EXPECT_EQ(middle(look), flat);
    look.paint = SurfacePaint::gaussian_curvature;
    EXPECT_GT(blue(middle(look)), red(middle(look)));
    look.paint = SurfacePaint::first_curvature;
    EXPECT_GT(red(middle(look)), blue(middle(look)));
    look.paint = SurfacePaint::second_curvature;
    EXPECT_GT(blue(middle(look)), red(middle(look)));
}

TEST_F(SurfacePainting, StepsAreThreeFromTheEye) {
    const PaintLook look{.light = SurfaceLight::steps, .plain = {200, 200, 200}};
    EXPECT_EQ(red(middle(look)), 200);
    normal_ = {0.9f, 0, 0.4359f, 0};
    EXPECT_NEAR(red(middle(look)), 172, 1);
    normal_ = {0.99f, 0, 0.141f, 0};
    EXPECT_NEAR(red(middle(look)), 144, 1);
}

TEST_F(SurfacePainting, AHeadlightLeavesColorsLight) {
    const PaintLook look{.light = SurfaceLight::headlight, .plain = {200, 200, 200}};
    EXPECT_EQ(red(middle(look)), 200);
    normal_ = {0.8f, 0, -0.6f, 0};
    EXPECT_NEAR(red(middle(look)), 200 * (0.45 + 0.55 * 0.6), 1);
    normal_ = {1, 0, 0, 0};
    EXPECT_NEAR(red(middle(look)), 90, 1);
}

// The paint and light of PaintLook by their numbers.
PaintLook look_of(std::uint32_t paint, std::uint32_t light) {
    return {
        .paint = static_cast<SurfacePaint>(paint), .light = static_cast<SurfaceLight>(light), .plain = {90, 120, 30}};
}

TEST_F(SurfacePainting, EveryPaintIsDrawnInEveryLightHoweverVerticesCome) {
    k1_ = 0.7f;
    k2_ = 0.1f;
    normal_ = {0.9f, 0, 0.4359f, 0};
    std::set<std::vector<std::uint32_t>> pictures;
    for (std::uint32_t paint = 0; paint < shared::k_paints; ++paint)
        for (std::uint32_t light = 0; light < shared::k_lights; ++light) {
            by_corner_ = false;
            const std::vector<std::uint32_t> texels = draw(look_of(paint, light));
            for (const std::uint32_t texel : texels) EXPECT_NE(texel, 0xffffffffu) << paint << ' ' << light;
            by_corner_ = true;
            EXPECT_EQ(draw(look_of(paint, light)), texels) << paint << ' ' << light;
            pictures.insert(texels);
        }
    EXPECT_EQ(pictures.size(), shared::k_paints * shared::k_lights);
}

TEST_F(SurfacePainting, IsPlainWhereALookNeedsWhatIsNotThere) {
    colored_ = curved_ = false;
    for (std::uint32_t light = 0; light < shared::k_lights; ++light) {
        const std::vector<std::uint32_t> plain = draw(look_of(shared::k_paint_plain, light));
        for (std::uint32_t paint = shared::k_paint_faces; paint <= shared::k_paint_second; ++paint)
            EXPECT_EQ(draw(look_of(paint, light)), plain) << paint;
    }
}

TEST_F(SurfacePainting, BackgroundAndPaperMayBeTransparent) {
    half_height_ = 2;  // the surface is the middle half
    const std::size_t inside = k_size / 2 * k_size + k_size / 2, outside = 2 * k_size + 2;
    PaintLook look{.light = SurfaceLight::none, .plain = {10, 20, 30}, .background = {1, 2, 3}};
    EXPECT_EQ(draw(look)[outside], 0xff030201u);
    EXPECT_EQ(draw(look)[inside], 0xff1e140au);
    look.transparent_plain = true;  // there is a background
    EXPECT_EQ(draw(look)[inside], 0xff1e140au);
    look.transparent = true;
    EXPECT_EQ(draw(look)[outside], 0u);
    EXPECT_EQ(draw(look)[inside], 0u);
    look.transparent_plain = false;
    EXPECT_EQ(draw(look)[outside], 0u);
    EXPECT_EQ(draw(look)[inside], 0xff1e140au);
    look.transparent_plain = true;
    look.paint = SurfacePaint::faces;  // which is no paper
    EXPECT_EQ(draw(look)[inside] >> 24, 0xffu);
}

}  // namespace
}  // namespace exemplar
