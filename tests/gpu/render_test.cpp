#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "gpu/imaging/mesh_renderer.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "host/core/random.h"
#include "host/imaging/raster.h"
#include "tests/gpu/support/environment.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using test_support::shared_device;

constexpr Color k_white{255, 255, 255};

class Render : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { shared_renderer = std::make_unique<MeshRenderer>(shared_device()); }
    static void TearDownTestSuite() { shared_renderer.reset(); }
    static std::unique_ptr<MeshRenderer> shared_renderer;
};
std::unique_ptr<MeshRenderer> Render::shared_renderer;

std::vector<Color> random_colors(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<Color> colors(count);
    for (Color& color : colors)
        for (std::uint8_t& channel : color) channel = static_cast<std::uint8_t>(random.uniform() * 256);
    return colors;
}

// The same color for large pieces, so that most pixels lie inside one.
std::vector<Color> halves(const TriangleMesh& mesh) {
    std::vector<Color> colors;
    for (const Vec3& center : face_centers(mesh)) colors.push_back(label_color(center.x() > 0 ? 0 : 1));
    return colors;
}

Color color_at(const Image& image, int x, int y) {
    const auto p = image.pixel(x, y);
    return {p[0], p[1], p[2]};
}

int difference(const Color& a, const Color& b) {
    int largest = 0;
    for (std::size_t c = 0; c < 3; ++c) largest = std::max(largest, std::abs(int{a[c]} - int{b[c]}));
    return largest;
}

// Calls `look` with every pixel of the 3 x 3 neighborhood that is inside the image.
template <typename Look>
void around(const Image& image, int x, int y, Look&& look) {
    for (int v = std::max(0, y - 1); v <= std::min(image.height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(image.width - 1, x + 1); ++u) look(color_at(image, u, v));
}

// What is on the mesh and varies so little around a pixel that it matters little if an edge moves by a sample.
constexpr int k_little_variation = 3;

struct Comparison {
    double mean = 0;             // of the absolute differences of all channels
    int largest_inside = 0;      // among pixels of the mesh with little variation around them in the reference
    double inside = 0;           // their share of the mesh's pixels
    std::size_t silhouette = 0;  // pixels that are background in one image only, though no edge pixels of the reference
};

Comparison compare(const Image& expected, const Image& actual) {
    EXPECT_EQ(actual.width, expected.width);
    EXPECT_EQ(actual.height, expected.height);
    EXPECT_EQ(actual.channels, 3);
    Comparison result;
    for (std::size_t i = 0; i < expected.data.size(); ++i)
        result.mean += std::abs(int{expected.data[i]} - int{actual.data[i]});
    result.mean /= static_cast<double>(expected.data.size());
    std::size_t on_mesh = 0, inside = 0;
    for (int y = 0; y < expected.height; ++y)
        for (int x = 0; x < expected.width; ++x) {
            const Color here = color_at(expected, x, y), there = color_at(actual, x, y);
            int variation = 0;
            bool edge = false;
            around(expected, x, y, [&](const Color& neighbor) {
                variation = std::max(variation, difference(here, neighbor));
                edge = edge || (neighbor == k_white) != (here == k_white);
            });
            if ((here == k_white) != (there == k_white) && !edge) ++result.silhouette;
            if (here == k_white) continue;
            ++on_mesh;
            if (variation > k_little_variation) continue;
            ++inside;
            result.largest_inside = std::max(result.largest_inside, difference(here, there));
        }
    result.inside = static_cast<double>(inside) / static_cast<double>(std::max<std::size_t>(on_mesh, 1));
    return result;
}

// Samples on either side of an edge are up to 255 apart, and devices place edges up to 1/16 of a sample elsewhere:
// a few of the samples near edges differ. Elsewhere only half floats, pow and rounding to 8 bits do.
void expect_same_picture(const TriangleMesh& mesh, const Camera& camera, int width, int height, MeshRenderer& renderer,
                         const RenderOptions& options = {}) {
    const std::vector<Color> colors = halves(mesh);
    const Image expected = render_mesh(mesh, colors, camera, width, height, options);
    const Comparison result = compare(expected, renderer.render(mesh, colors, camera, width, height, options));
    EXPECT_LT(result.mean, 0.5);
    EXPECT_LE(result.largest_inside, 2);
    EXPECT_GT(result.inside, 0.1);
    EXPECT_EQ(result.silhouette, 0u);
}

TEST_F(Render, AgreesWithTheReference) {
    struct Case {
        const char* name;
        TriangleMesh mesh;
        int width, height;
    };
    const std::vector<Case> cases{{"sphere", shapes::icosphere(3, 1.0f), 160, 120},
                                  {"torus", shapes::torus(2.0f, 0.7f, 48, 24), 97, 131},
                                  {"box", shapes::box(1.0f, 2.0f, 3.0f, 4), 121, 63},
                                  {"far away", shapes::translated(shapes::icosphere(2, 0.1f), {50, -20, 7}), 64, 64},
                                  {"open", shapes::cylinder(0.5f, 2.0f, 31, 5, false), 80, 200}};
    for (const Case& c : cases)
        for (const bool smooth : {true, false})
            for (const float fov : {0.0f, 0.9f}) {
                SCOPED_TRACE(std::string(c.name) + (smooth ? ", smooth" : ", flat") + (fov > 0 ? "" : ", parallel"));
                const Camera camera =
                    fit_camera(c.mesh, Vec3(0.6f, 0.5f, 1.0f),
                               static_cast<float>(c.width) / static_cast<float>(c.height), {.vertical_fov = fov});
                RenderOptions options;
                options.smooth = smooth;
                expect_same_picture(c.mesh, camera, c.width, c.height, *shared_renderer, options);
            }
}

TEST_F(Render, AgreesWithTheReferenceInsideAMesh) {
    // The eye sits in the tube: faces cross the near plane and the eye's plane.
    const TriangleMesh mesh = shapes::torus(2.0f, 0.7f, 48, 24);
    Camera camera;
    camera.view = look_at({2.0f, 0.1f, 0.05f}, {1.8f, 1.5f, 0.0f});
    camera.projection = perspective(1.2f, 1.5f, 0.05f, 10.0f);
    expect_same_picture(mesh, camera, 150, 100, *shared_renderer);
}

TEST_F(Render, EveryFaceHasItsOwnColor) {
    // One face per pixel column and row, light off but for a constant: pixels are the faces' colors.
    const TriangleMesh mesh = shapes::grid(8, 8, 8.0f);
    const std::vector<Color> colors = random_colors(mesh.face_count(), 5);
    RenderOptions options;
    options.ambient = 1.0f;
    options.ground = 1.0f;
    options.headlight = 0.0f;
    const Camera camera = fit_camera(mesh, Vec3::UnitZ(), 1.0f, {.vertical_fov = 0.0f, .margin = 0.0f});
    const Image image = shared_renderer->render(mesh, colors, camera, 128, 128, options);
    for (std::size_t face = 0; face < mesh.face_count(); ++face) {
        const Vec3 center = camera.project(face_centers(mesh)[face], image.width, image.height);
        EXPECT_LE(difference(color_at(image, static_cast<int>(center.x()), static_cast<int>(center.y())), colors[face]),
                  1)
            << "face " << face;
    }
}

TEST_F(Render, LightFollowsTheFormula) {
    // A square that faces the viewer along +z: n . to_eye = 1, n.y = 0.
    const TriangleMesh mesh = shapes::grid(1, 1, 1.0f);
    const Color gray{128, 128, 128};
    const Camera camera = fit_camera(mesh, Vec3::UnitZ(), 1.0f, {.vertical_fov = 0.0f});
    const RenderOptions options;
    const Image image = shared_renderer->render(mesh, std::vector(2, gray), camera, 32, 32, options);
    const float light = options.ambient * (options.ground + (1 - options.ground) * 0.5f) + options.headlight;
    const auto expected =
        static_cast<std::uint8_t>(std::lround(linear_to_srgb(srgb_to_linear(128.0f / 255) * light) * 255));
    EXPECT_LE(difference(color_at(image, 16, 16), {expected, expected, expected}), 1);
    EXPECT_EQ(color_at(image, 0, 0), k_white);
}

TEST_F(Render, TheNearestSurfaceIsSeenInAnyOrderOfFaces) {
    const TriangleMesh square = shapes::grid(1, 1, 1.0f);
    const TriangleMesh behind = shapes::translated(square, {0, 0, -1});
    const Camera camera = fit_camera(shapes::joined(square, behind), Vec3::UnitZ(), 1.0f, {.vertical_fov = 0.0f});
    const Color red{200, 0, 0}, blue{0, 0, 200};
    for (const bool near_first : {true, false}) {
        const TriangleMesh mesh = near_first ? shapes::joined(square, behind) : shapes::joined(behind, square);
        std::vector<Color> colors(4, blue);
        for (std::size_t i : {0u, 1u}) colors[near_first ? i : i + 2] = red;
        const Color seen = color_at(shared_renderer->render(mesh, colors, camera, 16, 16), 8, 8);
        EXPECT_GT(seen[0], 150);
        EXPECT_EQ(seen[2], 0);
    }
}

TEST_F(Render, SurfacesHaveTwoSides) {
    const TriangleMesh mesh = shapes::icosphere(2, 1.0f);
    TriangleMesh inside_out = mesh;
    for (Face& face : inside_out.faces) std::swap(face[1], face[2]);
    const Camera camera = fit_camera(mesh, {1, 1, 1}, 1.0f);
    const Comparison result = compare(shared_renderer->render(mesh, halves(mesh), camera, 90, 90),
                                      shared_renderer->render(inside_out, halves(mesh), camera, 90, 90));
    EXPECT_LT(result.mean, 0.05);
    EXPECT_EQ(result.silhouette, 0u);
}

TEST_F(Render, TilesJoinWithoutSeams) {
    const TriangleMesh mesh = shapes::torus(2.0f, 0.7f, 48, 24);
    const Camera camera = fit_camera(mesh, Vec3(0.6f, 0.5f, 1.0f), 150.0f / 101.0f);
    MeshRenderer tiled(shared_device(), 32);
    const Comparison result = compare(shared_renderer->render(mesh, halves(mesh), camera, 150, 101),
                                      tiled.render(mesh, halves(mesh), camera, 150, 101));
    EXPECT_LT(result.mean, 0.1);
    EXPECT_LE(result.largest_inside, 1);
    EXPECT_EQ(result.silhouette, 0u);
}

// Parts of 7 faces, each with copies of the vertices it uses.
TEST_F(Render, MeshesOverTheLimitAreDrawnInParts) {
    const TriangleMesh mesh = shapes::torus(2.0f, 0.7f, 24, 12);
    const std::vector<Color> colors = random_colors(mesh.face_count(), 2);
    const Camera camera = fit_camera(mesh, Vec3(0.6f, 0.5f, 1.0f), 1.0f);
    MeshRenderer in_parts(shared_device(), 40, 7 * 36 + 5);
    MeshRenderer whole(shared_device(), 40);
    for (const bool smooth : {true, false}) {
        RenderOptions options;
        options.smooth = smooth;
        EXPECT_EQ(in_parts.render(mesh, colors, camera, 64, 64, options),
                  whole.render(mesh, colors, camera, 64, 64, options));
    }
}

TEST(MeshPart, HoldsTheFacesAndTheVerticesTheyUse) {
    const TriangleMesh mesh = shapes::grid(3, 3, 1.0f);
    const std::vector<Color> colors = random_colors(mesh.face_count(), 3);
    const std::vector<Vec3> normals(mesh.vertices.size(), Vec3::UnitZ());
    const MeshSurface surface{mesh.faces, mesh.vertices, normals, colors, true};
    const MeshPart part = cut_part(surface, 5, 2);
    ASSERT_EQ(part.faces.size(), 2u);
    EXPECT_LE(part.vertices.size(), 6u);
    EXPECT_EQ(part.normals.size(), part.vertices.size());
    for (std::size_t f = 0; f < 2; ++f) {
        EXPECT_EQ(part.colors[f], colors[5 + f]);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_EQ(part.vertices.at(part.faces[f][c]), mesh.vertices[mesh.faces[5 + f][c]]);
    }
    EXPECT_TRUE(fits(surface, mesh.face_count() * 12));
    EXPECT_FALSE(fits(surface, mesh.face_count() * 12 - 1));
    EXPECT_EQ(faces_per_part(1), 1u);
}

TEST_F(Render, RerunsAndOtherSizesBetweenThemChangeNothing) {
    const TriangleMesh mesh = shapes::icosphere(3, 1.0f);
    const std::vector<Color> colors = random_colors(mesh.face_count(), 1);
    const Camera camera = fit_camera(mesh, {1, 2, 3}, 1.0f);
    const Image first = shared_renderer->render(mesh, colors, camera, 75, 75);
    // Odd sizes: edges are most of these pictures, so only the mean says something.
    const TriangleMesh box = shapes::box(1, 1, 1, 3);
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(300, 2), std::pair(7, 200)}) {
        const Camera view = fit_camera(box, {1, 1, 2}, static_cast<float>(width) / static_cast<float>(height));
        const Comparison result = compare(render_mesh(box, halves(box), view, width, height),
                                          shared_renderer->render(box, halves(box), view, width, height));
        EXPECT_LT(result.mean, 3) << width << " x " << height;
    }
    EXPECT_EQ(shared_renderer->render(mesh, colors, camera, 75, 75), first);
}

TEST_F(Render, AMeshWithoutFacesIsBackground) {
    RenderOptions options;
    options.background = {10, 200, 90};
    const Image image = shared_renderer->render({}, {}, Camera{}, 9, 5, options);
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 9; ++x) EXPECT_LE(difference(color_at(image, x, y), options.background), 1);
}

TEST_F(Render, WrongArgumentsAreErrors) {
    const TriangleMesh mesh = shapes::icosphere(0, 1.0f);
    const Camera camera = fit_camera(mesh, {0, 0, 1}, 1.0f);
    const std::vector<Color> colors(mesh.face_count()), too_few(mesh.face_count() - 1);
    EXPECT_THROW(shared_renderer->render(mesh, colors, camera, 0, 8), UsageError);
    EXPECT_THROW(shared_renderer->render(mesh, colors, camera, 8, -1), UsageError);
    EXPECT_THROW(shared_renderer->render(mesh, too_few, camera, 8, 8), UsageError);
    EXPECT_THROW(MeshRenderer(shared_device(), 0), UsageError);
}

TEST_F(Render, TilesOverTheDevicesLimitNameIt) {
    VkPhysicalDeviceProperties properties{};
    vkGetPhysicalDeviceProperties(shared_device().physical(), &properties);
    const int limit = static_cast<int>(properties.limits.maxImageDimension2D);
    MeshRenderer renderer(shared_device(), limit);
    try {
        renderer.render({}, {}, Camera{}, limit, 1);
        FAIL() << "no error";
    } catch (const DeviceLimitError& error) {
        EXPECT_EQ(error.limit, properties.limits.maxImageDimension2D);
    }
    // The renderer is of use after the error.
    EXPECT_EQ(renderer.render({}, {}, Camera{}, 1, 1).data, std::vector<std::uint8_t>(3, 255));
}

}  // namespace
}  // namespace exemplar
