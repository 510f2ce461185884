#include "gpu/lines/line_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "host/core/errors.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"

namespace exemplar {
namespace {

using shared::vec4;
using test_support::shared_device;

constexpr int k_width = 90, k_height = 60;

/// A ball without curvature, in the middle of a picture.
struct Ball {
    TriangleMesh mesh = shapes::icosphere(3, 1);
    GpuSurface surface{shared_device(), mesh};
    GpuLineSurface line_surface{surface};
    Buffer vertices = test_support::upload_vertices(shared_device(), mesh.vertices);
    Buffer normals = test_support::upload_vertices(shared_device(), mesh.vertices);
    LinePicture picture;

    Ball() {
        picture.view = {.camera = fit_camera(mesh, Vec3(0.1f, 0.2f, 1), float(k_width) / k_height),
                        .width = k_width,
                        .height = k_height,
                        .unit_depth = 10,
                        .feature_size = 0};
        picture.looks = plain_looks({}, {});
    }
    GpuCurvedSurface snapshot() const { return {vertices, normals}; }
    Image render(LineRenderer& renderer, Profiler* profiler = nullptr) const {
        Stream stream(shared_device(), profiler);
        return renderer.render(stream, snapshot(), picture);
    }
};

std::array<int, 4> pixel_at(const Image& image, int x, int y) {
    std::array<int, 4> result{0, 0, 0, 255};
    std::copy(image.pixel(x, y).begin(), image.pixel(x, y).end(), result.begin());
    return result;
}

TEST(LineRenderer, DrawsTheSurfaceAloneWithoutTypesOfLines) {
    Ball ball;
    ball.picture.surface.background = {10, 20, 30};
    ball.picture.surface.plain = {200, 100, 50};
    LineRenderer renderer(shared_device(), ball.line_surface);
    Profiler profiler;
    const Image image = ball.render(renderer, &profiler);
    EXPECT_EQ(pixel_at(image, 0, 0), (std::array{10, 20, 30, 255}));
    EXPECT_EQ(pixel_at(image, k_width / 2, k_height / 2), (std::array{200, 100, 50, 255}));
    for (int y = 0; y < k_height; ++y)
        for (int x = 0; x < k_width; ++x) {
            const int red = pixel_at(image, x, y)[0];
            ASSERT_TRUE(red == 10 || red == 200) << x << ' ' << y;
        }
    for (const auto& [what, entry] : profiler.entries()) EXPECT_EQ(what, "surface");
}

TEST(LineRenderer, LinesComeAndGoWithTheirTypes) {
    Ball ball;
    LineRenderer renderer(shared_device(), ball.line_surface);
    const Image without = ball.render(renderer);
    ball.picture.families = 1u << shared::k_contours;
    const Image with = ball.render(renderer);
    EXPECT_TRUE(std::ranges::any_of(with.data, [](std::uint8_t value) { return value < 50; }));
    ball.picture.families = 0;
    EXPECT_EQ(ball.render(renderer), without);
    ball.picture.families = 1u << shared::k_contours;
    EXPECT_EQ(ball.render(renderer), with);
}

TEST(LineRenderer, BackgroundAndPaperMayBeTransparent) {
    Ball ball;
    ball.picture.surface.plain = {200, 100, 50};
    ball.picture.surface.transparent = true;
    LineRenderer renderer(shared_device(), ball.line_surface);
    for (const std::uint32_t families : {0u, 1u << shared::k_contours}) {
        ball.picture.families = families;
        ball.picture.surface.transparent_plain = false;
        const Image paper = ball.render(renderer);
        ASSERT_EQ(paper.channels, 4);
        EXPECT_EQ(pixel_at(paper, 0, 0), (std::array{0, 0, 0, 0}));
        EXPECT_EQ(pixel_at(paper, k_width / 2, k_height / 2), (std::array{200, 100, 50, 255}));
        ball.picture.surface.transparent_plain = true;
        const Image strokes = ball.render(renderer);
        EXPECT_EQ(pixel_at(strokes, 0, 0), (std::array{0, 0, 0, 0}));
        EXPECT_EQ(pixel_at(strokes, k_width / 2, k_height / 2), (std::array{0, 0, 0, 0}));
        int opaque = 0;
        for (std::size_t i = 3; i < strokes.data.size(); i += 4) opaque += strokes.data[i] > 200;
        EXPECT_EQ(opaque > 0, families != 0);
    }
}

TEST(LineRenderer, FacesHaveTheColorsTheyWereGivenLast) {
    Ball ball;
    ball.picture.surface = {.paint = SurfacePaint::faces, .light = SurfaceLight::none, .plain = {1, 2, 3}};
    LineRenderer renderer(shared_device(), ball.line_surface);
    const auto middle = [&] { return pixel_at(ball.render(renderer), k_width / 2, k_height / 2); };
    EXPECT_EQ(middle(), (std::array{1, 2, 3, 255}));
    for (const Color& color : {Color{250, 0, 10}, Color{0, 90, 30}}) {
        renderer.set_face_colors(std::vector<Color>(ball.mesh.face_count(), color));
        EXPECT_EQ(middle(), (std::array{int{color[0]}, int{color[1]}, int{color[2]}, 255}));
    }
    EXPECT_THROW(renderer.set_face_colors(std::vector<Color>(3)), UsageError);
}

TEST(LineRenderer, LinesOfAPartHaveItsInkOrNone) {
    Ball ball;
    ball.picture.families = 1u << shared::k_contours;
    LineRenderer renderer(shared_device(), ball.line_surface);
    const Image plain = ball.render(renderer);
    const auto count = [](const Image& image, bool red) {
        std::size_t pixels = 0;
        for (std::size_t i = 0; i < image.data.size(); i += static_cast<std::size_t>(image.channels)) {
            const int green = image.data[i + 1];
            pixels += green < 80 && (image.data[i] > green + 100) == red;
        }
        return pixels;
    };
    const std::size_t black = count(plain, false);
    ASSERT_GT(black, 50U);
    for (const float width : {1.0F, 0.0F}) {
        PartInks inks{{PartInk{}, {Color{255, 0, 0}, width}}, {"", "part"}, {}};
        for (const Face& face : ball.mesh.faces)
            inks.ink_of_face.push_back(ball.mesh.vertices[face[0]].x() > 0 ? 1 : 0);
        renderer.set_part_inks(inks);
        const Image image = ball.render(renderer);
        EXPECT_NEAR(static_cast<double>(count(image, false)), static_cast<double>(black) / 2,
                    0.1 * static_cast<double>(black));
        EXPECT_EQ(count(image, true) > black / 3, width > 0);
        EXPECT_EQ(count(image, true) > 0, width > 0);
    }
    renderer.set_part_inks({});
    EXPECT_EQ(ball.render(renderer), plain);
    EXPECT_THROW(renderer.set_part_inks({{PartInk{}}, {""}, {0, 0}}), UsageError);
}

TEST(LineRenderer, OtherVerticesAreRefused) {
    const Ball ball;
    LineRenderer renderer(shared_device(), ball.line_surface);
    Stream stream(shared_device());
    const Buffer few(shared_device(), 3 * sizeof(vec4));
    EXPECT_THROW(renderer.record(stream, {few, ball.normals}, ball.picture), UsageError);
}

}  // namespace
}  // namespace exemplar
