#include "apps/viewer/painting/brush.h"

#include <gtest/gtest.h>

#include "host/imaging/gbuffer.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// A sphere seen from +z in a picture of 200 x 160.
struct SeenSphere {
    TriangleMesh mesh = shapes::icosphere(3, 1.0F);
    FacePicture picture;
    SeenSphere() {
        picture.width = 200, picture.height = 160;
        picture.camera = fit_camera(mesh, Vec3::UnitZ(), 1.25F);
        picture.face = render_gbuffer(mesh, picture.camera, picture.width, picture.height).face;
    }
};

TEST(Brush, TouchesWhatIsSeenWithinItsRadius) {
    const SeenSphere sphere;
    const auto faces = brushed_faces(sphere.picture, {100, 80}, {100, 80}, 6);
    ASSERT_FALSE(faces.empty());
    EXPECT_TRUE(std::ranges::is_sorted(faces));
    const std::vector<Vec3> center = face_centers(sphere.mesh);
    for (const std::uint32_t face : faces) EXPECT_GT(center[face].z(), 0.95F);
    EXPECT_TRUE(std::ranges::binary_search(faces, face_at(sphere.picture, {100, 80})));
}

TEST(Brush, LeavesNoGapOnTheWay) {
    const SeenSphere sphere;
    const auto faces = brushed_faces(sphere.picture, {50, 80}, {150, 80}, 2);
    for (float x = 50; x <= 150; ++x)
        EXPECT_TRUE(std::ranges::binary_search(faces, face_at(sphere.picture, {x, 80}))) << x;
    for (const std::uint32_t face : faces) {
        const Vec3 place = sphere.picture.camera.project(face_centers(sphere.mesh)[face], 200, 160);
        EXPECT_NEAR(place.y(), 80, 15);
    }
}

TEST(Brush, ThroughTheMeshTakesBothSides) {
    const SeenSphere sphere;
    const auto seen = brushed_faces(sphere.picture, {100, 80}, {100, 80}, 20);
    const auto all = brushed_faces_through(sphere.mesh, sphere.picture, {100, 80}, {100, 80}, 20);
    const std::vector<Vec3> center = face_centers(sphere.mesh);
    const auto behind = std::ranges::count_if(all, [&](std::uint32_t f) { return center[f].z() < 0; });
    EXPECT_GT(behind, 0);
    EXPECT_NEAR(static_cast<double>(behind), static_cast<double>(all.size()) / 2,
                0.2 * static_cast<double>(all.size()));
    EXPECT_GT(all.size(), seen.size());
}

TEST(Brush, BesideTheMeshOrThePictureTouchesNothing) {
    const SeenSphere sphere;
    EXPECT_TRUE(brushed_faces(sphere.picture, {2, 2}, {5, 2}, 3).empty());
    EXPECT_TRUE(brushed_faces(sphere.picture, {-500, -500}, {-400, -400}, 30).empty());
    EXPECT_EQ(face_at(sphere.picture, {-1, 5}), k_no_face);
    EXPECT_EQ(face_at(sphere.picture, {200, 5}), k_no_face);
    EXPECT_EQ(face_near(sphere.picture, {2, 2}, 5), k_no_face);
    EXPECT_NE(face_near(sphere.picture, {100, 2}, 10), k_no_face);
}

TEST(Lasso, TakesWhatItEnclosesForTheMostPart) {
    const SeenSphere sphere;
    const std::vector<Vec2> left{{0, 0}, {100, 0}, {100, 160}, {0, 160}};
    const auto faces = faces_in_lasso(sphere.picture, left);
    const auto through = faces_in_lasso_through(sphere.mesh, sphere.picture, left);
    const std::vector<Vec3> center = face_centers(sphere.mesh);
    for (const std::uint32_t face : faces) EXPECT_LT(center[face].x(), 0.1F);
    for (const std::uint32_t face : through) EXPECT_LT(center[face].x(), 0.01F);
    EXPECT_NEAR(static_cast<double>(through.size()), static_cast<double>(sphere.mesh.face_count()) / 2, 40);
    EXPECT_LT(faces.size(), through.size());
    EXPECT_TRUE(faces_in_lasso(sphere.picture, std::span(left).first(2)).empty());
}

}  // namespace
}  // namespace exemplar
