#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/imaging/camera.h"
#include "host/imaging/png.h"
#include "host/imaging/raster.h"
#include "host/imaging/side_by_side.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

class PngFile : public testing::Test {
  protected:
    const TemporaryFolder folder_;
};

Image random_image(int width, int height, int channels, std::uint64_t seed) {
    Image image(width, height, channels);
    Random random(seed);
    for (std::uint8_t& value : image.data) value = static_cast<std::uint8_t>(random.index(256));
    return image;
}

TEST_F(PngFile, KeepsEveryPixelOfEveryFormat) {
    for (const int channels : {1, 3, 4}) {
        for (const auto& [width, height] : {std::pair{1, 1}, std::pair{7, 3}, std::pair{64, 65}}) {
            const Image image = random_image(width, height, channels, 5);
            write_png(folder_ / "deeper" / "a.png", image);
            EXPECT_EQ(read_png(folder_ / "deeper" / "a.png"), image);
        }
    }
}

TEST_F(PngFile, HoldsTextThatOtherProgramsPassOver) {
    const Image image = random_image(33, 21, 3, 9);
    write_png(folder_ / "a.png", image, {"View", "{\"eye\":[1,2,3]}"});
    EXPECT_EQ(read_png(folder_ / "a.png"), image);
    const std::string bytes = read_file(folder_ / "a.png");
    EXPECT_EQ(png_text(bytes, "View"), "{\"eye\":[1,2,3]}");
    EXPECT_FALSE(png_text(bytes, "Vie"));
    EXPECT_FALSE(png_text(bytes, "View of"));
    for (std::size_t size = 0; size < 60; ++size) EXPECT_FALSE(png_text(bytes.substr(0, size), "View"));
    std::string damaged = bytes;
    damaged[damaged.find("eye")] = 'E';
    EXPECT_FALSE(png_text(damaged, "View")) << "its checksum is wrong";
}

TEST_F(PngFile, SameImageGivesSameBytesAndNoLeftovers) {
    const Image image = random_image(33, 21, 3, 9);
    write_png(folder_ / "a.png", image);
    write_png(folder_ / "b.png", image);
    EXPECT_EQ(read_file(folder_ / "a.png"), read_file(folder_ / "b.png"));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2);
}

TEST_F(PngFile, RefusesDamagedFilesNamingThem) {
    const Image image = random_image(40, 30, 3, 2);
    write_png(folder_ / "good.png", image);
    const std::string good = read_file(folder_ / "good.png");
    std::string flipped = good;
    flipped[good.size() / 2] = static_cast<char>(flipped[good.size() / 2] ^ 0x55);
    for (const std::string& bytes :
         {std::string(), std::string("not a png"), good.substr(0, 20), good.substr(0, good.size() / 2), flipped}) {
        std::ofstream(folder_ / "bad.png", std::ios::binary | std::ios::trunc) << bytes;
        try {
            read_png(folder_ / "bad.png");
            ADD_FAILURE() << "accepted " << bytes.size() << " bytes";
        } catch (const DataError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("bad.png"));
        }
    }
    EXPECT_THROW(read_png(folder_ / "missing.png"), DataError);
}

TEST_F(PngFile, RefusesAnImageThatIsAHugeClaim) {
    // Signature and an IHDR of 2^30 x 2^30 RGB pixels.
    const unsigned char header[] = {0x89, 'P', 'N', 'G',  13, 10, 26, 10, 0, 0, 0, 13, 'I', 'H', 'D', 'R', 0x40,
                                    0,    0,   0,   0x40, 0,  0,  0,  8,  2, 0, 0, 0,  0,   0,   0,   0};
    std::ofstream(folder_ / "huge.png", std::ios::binary).write(reinterpret_cast<const char*>(header), sizeof header);
    EXPECT_THROW(read_png(folder_ / "huge.png"), DataError);
}

TEST_F(PngFile, RefusesToWriteWhatPngCannotHold) {
    EXPECT_THROW(write_png(folder_ / "a.png", Image(2, 2, 2)), UsageError);
    EXPECT_THROW(write_png(folder_ / "a.png", Image()), UsageError);
    EXPECT_THROW(write_png("/proc/no/such/place.png", Image(1, 1, 1)), DataError);
}

TEST(Camera, PerspectivePutsKnownPointsWhereVulkanExpectsThem) {
    Camera camera;
    camera.view = look_at(Vec3(0, 0, 5), Vec3::Zero());
    camera.projection = perspective(2 * std::atan(0.5f), 2, 1, 9);
    EXPECT_TRUE(camera.project(Vec3::Zero(), 200, 100).head<2>().isApprox(Vec2(100, 50)));
    // At distance 5 the view is 5 high and 10 wide; y points down on the screen.
    EXPECT_TRUE(camera.project(Vec3(5, 2.5f, 0), 200, 100).head<2>().isApprox(Vec2(200, 0), 1e-4f));
    EXPECT_TRUE(camera.project(Vec3(-5, -2.5f, 0), 200, 100).head<2>().isApprox(Vec2(0, 100), 1e-4f));
    EXPECT_NEAR(camera.project(Vec3(0, 0, 4), 200, 100).z(), 0, 1e-6);
    EXPECT_NEAR(camera.project(Vec3(0, 0, -4), 200, 100).z(), 1, 1e-6);
    EXPECT_TRUE(camera.position().isApprox(Vec3(0, 0, 5)));
    EXPECT_TRUE(camera.to_eye(Vec3(0, 0, 1)).isApprox(Vec3::UnitZ()));
}

TEST(Camera, OrthographicIsLinearInDepth) {
    Camera camera;
    camera.view = look_at(Vec3(3, 0, 0), Vec3::Zero());
    camera.projection = orthographic(2, 1.5f, 1, 5);
    const Vec3 p = camera.project(Vec3(0, 1, -1.5f), 300, 200);
    EXPECT_TRUE(p.isApprox(Vec3(225, 50, 0.5f), 1e-5f)) << p;  // right of a viewer on +x is -z
    EXPECT_TRUE(camera.to_eye(Vec3(-7, 2, 1)).isApprox(Vec3::UnitX()));
}

TEST(Camera, LooksStraightDownWithoutAnUpDirection) {
    const Eigen::Matrix4f view = look_at(Vec3(0, 4, 0), Vec3::Zero());
    EXPECT_TRUE(view.allFinite());
    EXPECT_NEAR((view * Vec3::Zero().homogeneous()).z(), -4, 1e-5);
    EXPECT_TRUE((view.topLeftCorner<3, 3>() * view.topLeftCorner<3, 3>().transpose()).isIdentity(1e-5f));
    EXPECT_THROW(look_at(Vec3::Ones(), Vec3::Ones()), UsageError);
}

TEST(Camera, FitShowsAllOfTheMeshAsLargeAsItFits) {
    Random random(11);
    TriangleMesh mesh;
    for (int i = 0; i < 50; ++i)
        mesh.vertices.push_back(Vec3(9, -4, 2) + Vec3(static_cast<float>(random.normal()),
                                                      3 * static_cast<float>(random.normal()),
                                                      static_cast<float>(random.normal())));
    for (const float fov : {0.0f, 0.5f, 1.2f}) {
        for (const Vec3& direction : {Vec3(1, 0.3f, 2), Vec3(0, 1, 0), Vec3(-3, -1, 0.1f)}) {
            FitOptions options;
            options.vertical_fov = fov;
            const Camera camera = fit_camera(mesh, direction, 1.5f, options);
            float reach = 0;
            for (const Vec3& v : mesh.vertices) {
                const Vec3 p = camera.project(v, 2, 2) - Vec3(1, 1, 0);
                reach = std::max({reach, std::abs(p.x()), std::abs(p.y())});
                EXPECT_GT(p.z(), 0);
                EXPECT_LT(p.z(), 1);
            }
            EXPECT_NEAR(reach, 0.95f, 1e-3);
        }
    }
    for (const float unit : {1e-9f, 1e-6f, 1e6f}) {
        TriangleMesh scaled = mesh;
        for (Vec3& v : scaled.vertices) v *= unit;
        const Camera camera = fit_camera(scaled, Vec3(1, 0.3f, 2), 1.5f);
        float reach = 0;
        for (const Vec3& v : scaled.vertices) {
            const Vec3 p = camera.project(v, 2, 2) - Vec3(1, 1, 0);
            reach = std::max({reach, std::abs(p.x()), std::abs(p.y())});
        }
        EXPECT_NEAR(reach, 0.95f, 1e-3) << unit;
    }
    for (const Vec3& place : {Vec3(0, 0, 0), Vec3(1e6f, 5, -3e4f), Vec3(1e-7f, 0, 0)}) {
        TriangleMesh point;
        point.vertices = {place, place, place};
        EXPECT_TRUE(fit_camera(point, Vec3(1, 0.3f, 2), 1).view_projection().allFinite()) << place;
    }
    EXPECT_THROW(fit_camera(TriangleMesh{}, Vec3::UnitX(), 1), MeshError);
    EXPECT_THROW(fit_camera(mesh, Vec3::Zero(), 1), UsageError);
}

/// A camera on +z that sees [-1, 1] x [-1, 1].
Camera square_camera() {
    Camera camera;
    camera.view = look_at(Vec3(0, 0, 10), Vec3::Zero());
    camera.projection = orthographic(1, 1, 1, 20);
    return camera;
}

/// Appends the rectangle [x0, x1] x [y0, y1] at depth z, facing +z.
void add_rectangle(TriangleMesh& mesh, float x0, float y0, float x1, float y1, float z) {
    const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec2& p : {Vec2(x0, y0), Vec2(x1, y0), Vec2(x1, y1), Vec2(x0, y1)})
        mesh.vertices.emplace_back(p.x(), p.y(), z);
    mesh.faces.push_back({n, n + 1, n + 2});
    mesh.faces.push_back({n, n + 2, n + 3});
}

Color pixel_color(const Image& image, int x, int y) {
    const auto p = image.pixel(x, y);
    return {p[0], p[1], p[2]};
}

/// Ambient light on a surface that faces the horizon plus the whole headlight, on a full-white surface.
std::uint8_t lit_white(const RenderOptions& options) {
    const float light = options.ambient * (options.ground + 1) / 2 + options.headlight;
    return static_cast<std::uint8_t>(std::lround(linear_to_srgb(std::min(light, 1.0f)) * 255));
}

TEST(Raster, CoversExactlyThePixelsInsideAndLightsThem) {
    TriangleMesh mesh;
    add_rectangle(mesh, -0.5f, 0, 0.5f, 0.75f, 0);  // pixels 4..11 x 2..7 of 16 x 16
    RenderOptions options;
    options.background = {10, 20, 30};
    const Image image =
        render_mesh(mesh, std::vector<Color>(2, Color{255, 255, 255}), square_camera(), 16, 16, options);
    const std::uint8_t white = lit_white(options);
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const bool inside = x >= 4 && x < 12 && y >= 2 && y < 8;
            EXPECT_EQ(pixel_color(image, x, y), inside ? (Color{white, white, white}) : options.background)
                << x << ' ' << y;
        }
    }
}

TEST(Raster, AveragesFourSamplesInLinearColor) {
    TriangleMesh mesh;
    add_rectangle(mesh, -1, -1, 0.125f, 1, 0);  // ends in the middle of pixel 4 of 8
    RenderOptions options;
    options.background = {0, 0, 0};
    const Image image = render_mesh(mesh, std::vector<Color>(2, Color{255, 255, 255}), square_camera(), 8, 8, options);
    const float light = std::min(options.ambient * (options.ground + 1) / 2 + options.headlight, 1.0f);
    EXPECT_EQ(image.pixel(4, 3)[0], std::lround(linear_to_srgb(light / 2) * 255));
}

TEST(Raster, SharedEdgesLeaveNoGapAtAnyAngle) {
    // A fan of triangles around the center covers the view: the background must not show anywhere.
    TriangleMesh mesh;
    mesh.vertices.emplace_back(0.013f, -0.027f, 0.0f);
    constexpr std::uint32_t k_blades = 37;
    for (std::uint32_t i = 0; i < k_blades; ++i) {
        const float angle = 6.2831853f * static_cast<float>(i) / k_blades;
        mesh.vertices.emplace_back(3 * std::cos(angle), 3 * std::sin(angle), 0.0f);
        mesh.faces.push_back({0, 1 + i, 1 + (i + 1) % k_blades});
    }
    const Image image = render_mesh(mesh, std::vector<Color>(k_blades, Color{255, 255, 255}), square_camera(), 101, 97,
                                    {.background = {0, 0, 0}});
    EXPECT_EQ(*std::min_element(image.data.begin(), image.data.end()), lit_white({}));
}

TEST(Raster, NearerFacesHideFartherOnesInAnyOrder) {
    for (const bool near_first : {true, false}) {
        TriangleMesh mesh;
        add_rectangle(mesh, -1, -1, 1, 1, near_first ? 1.0f : -1.0f);
        add_rectangle(mesh, -1, -1, 1, 1, near_first ? -1.0f : 1.0f);
        std::vector<Color> colors(4, Color{255, 0, 0});
        std::fill_n(colors.begin() + (near_first ? 0 : 2), 2, Color{0, 255, 0});
        const Image image = render_mesh(mesh, colors, square_camera(), 9, 9);
        EXPECT_EQ(pixel_color(image, 4, 4)[0], 0);
        EXPECT_GT(pixel_color(image, 4, 4)[1], 200);
    }
}

TEST(Raster, ClipsAtTheNearPlaneAndDropsWhatIsBehindTheEye) {
    TriangleMesh floor;  // runs from far in front of the eye to far behind it, half a unit below
    floor.vertices = {Vec3(-50, -0.5f, -50), Vec3(-50, -0.5f, 50), Vec3(50, -0.5f, 50), Vec3(50, -0.5f, -50)};
    floor.faces = {{0, 1, 2}, {0, 2, 3}};
    Camera camera;
    camera.view = look_at(Vec3::Zero(), Vec3(0, 0, -1));
    camera.projection = perspective(1.5f, 1, 0.1f, 200);
    const Image image = render_mesh(floor, std::vector<Color>(2, Color{0, 0, 255}), camera, 40, 40);
    EXPECT_EQ(pixel_color(image, 20, 5), (Color{255, 255, 255}));
    for (const int y : {24, 30, 39}) EXPECT_EQ(pixel_color(image, 20, y)[0], 0) << y;
}

TEST(Raster, SmoothNormalsShadeAcrossFacesAndFlatOnesDoNot) {
    TriangleMesh roof;  // a ridge toward the viewer, slopes left and right
    roof.vertices = {Vec3(-1, -1, 0), Vec3(0, -1, 1), Vec3(1, -1, 0), Vec3(-1, 1, 0), Vec3(0, 1, 1), Vec3(1, 1, 0)};
    roof.faces = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
    const std::vector<Color> colors(4, Color{200, 200, 200});
    const Image flat = render_mesh(roof, colors, square_camera(), 32, 32, {.smooth = false});
    const Image smooth = render_mesh(roof, colors, square_camera(), 32, 32);
    EXPECT_EQ(pixel_color(flat, 4, 16), pixel_color(flat, 14, 16));
    EXPECT_GT(pixel_color(smooth, 15, 16)[0], pixel_color(smooth, 1, 16)[0] + 10);
}

TEST(Raster, IsTheSameOnAnyNumberOfThreads) {
    Random random(4);
    TriangleMesh mesh;
    std::vector<Color> colors;
    for (std::uint32_t i = 0; i < 200; ++i) {
        for (int k = 0; k < 3; ++k) mesh.vertices.emplace_back(random.normal(), random.normal(), random.normal());
        mesh.faces.push_back({3 * i, 3 * i + 1, 3 * i + 2});
        colors.push_back(Color{static_cast<std::uint8_t>(random.index(256)), 40, 200});
    }
    const Camera camera = fit_camera(mesh, Vec3(1, 1, 1), 1.3f);
    const Image many = render_mesh(mesh, colors, camera, 130, 100);
    const ThreadLimit one(1);
    EXPECT_EQ(render_mesh(mesh, colors, camera, 130, 100), many);
}

TEST(Raster, RefusesWrongSizesAndDrawsNothingForAnEmptyMesh) {
    EXPECT_THROW(render_mesh({}, {}, square_camera(), 0, 5), UsageError);
    EXPECT_THROW(render_mesh({}, std::vector<Color>(1), square_camera(), 5, 5), UsageError);
    const Image empty = render_mesh({}, {}, square_camera(), 3, 2);
    EXPECT_EQ(empty, Image(3, 2, 3, 255));
}

TEST(Raster, TransferFunctionsAreInverse) {
    for (int i = 0; i <= 255; ++i) {
        const float v = static_cast<float>(i) / 255;
        EXPECT_NEAR(linear_to_srgb(srgb_to_linear(v)), v, 1e-5);
    }
}

TEST(SideBySide, ImagesKeepTheirPixels) {
    Image left(2, 2, 3, 10), right(1, 2, 3, 20);
    left.pixel(1, 0)[2] = 11;
    right.pixel(0, 1)[0] = 21;
    const Image both = side_by_side(std::array{left, right, left});
    ASSERT_EQ(both.width, 5);
    ASSERT_EQ(both.height, 2);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 5; ++x) {
            const Image& from = x == 2 ? right : left;
            const std::span<const std::uint8_t> expected = from.pixel(x < 2 ? x : x == 2 ? 0 : x - 3, y);
            EXPECT_TRUE(std::ranges::equal(both.pixel(x, y), expected)) << x << ", " << y;
        }
}

TEST(SideBySide, OnlyAlikeImagesFit) {
    EXPECT_THROW(side_by_side(std::array{Image(2, 2, 3), Image(2, 3, 3)}), UsageError);
    EXPECT_THROW(side_by_side(std::array{Image(2, 2, 3), Image(2, 2, 4)}), UsageError);
    EXPECT_THROW(side_by_side({}), UsageError);
}

}  // namespace
}  // namespace exemplar
