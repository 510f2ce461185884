#include <limits>

#include "host/core/errors.h"
#include "tests/labeling/features/features_support.h"

namespace exemplar {
namespace {

using namespace feature_tests;

TriangleMesh mesh_of(std::vector<Vec3> vertices, std::vector<Face> faces) {
    TriangleMesh mesh;
    mesh.source_face_count = static_cast<std::uint32_t>(faces.size());
    mesh.vertices = std::move(vertices);
    mesh.faces = std::move(faces);
    return mesh;
}
const std::vector<Vec3> k_corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5F}, {2, 0, 1}};

struct Case {
    const char* name;
    TriangleMesh mesh;
};

std::vector<Case> awkward_meshes() {
    std::vector<Case> cases;
    cases.push_back({"single_triangle", mesh_of(k_corners, {{0, 1, 2}})});
    cases.push_back({"two_faces", mesh_of(k_corners, {{0, 1, 2}, {1, 3, 2}})});
    cases.push_back({"three_faces", mesh_of(k_corners, {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}})});
    cases.push_back({"three_loose_faces",
                     shapes::joined(mesh_of(k_corners, {{0, 1, 2}}), mesh_of(k_corners, {{1, 3, 2}, {0, 4, 1}}))});
    cases.push_back({"point", mesh_of({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}, {0, 1, 2}})});
    cases.push_back({"line", mesh_of({{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {{0, 1, 2}, {1, 3, 2}})});
    cases.push_back({"repeated_vertex", mesh_of(k_corners, {{0, 0, 1}, {0, 1, 2}, {1, 3, 2}, {3, 3, 3}})});
    cases.push_back({"duplicate_faces", mesh_of(k_corners, {{0, 1, 2}, {0, 1, 2}, {0, 2, 1}, {1, 3, 2}})});
    cases.push_back({"non_manifold", mesh_of(k_corners, {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}})});
    cases.push_back({"plane", shapes::grid(12, 9, 1.0F)});
    cases.push_back({"open_cylinder", shapes::cylinder(0.3F, 2.0F, 12, 10, false)});
    cases.push_back({"box", shapes::box(1, 1, 1, 1)});
    cases.push_back({"two_parts", shapes::joined(shapes::icosphere(2, 1.0F),
                                                 shapes::translated(shapes::box(1, 2, 1, 2), Vec3(4, 0, 0)))});
    cases.push_back({"tiny", shapes::scaled(shapes::icosphere(2, 1.0F), 1e-18F)});
    cases.push_back({"huge", shapes::scaled(shapes::icosphere(2, 1.0F), 1e18F)});
    cases.push_back({"far_away", shapes::translated(shapes::icosphere(2, 1.0F), Vec3(1e5F, 0, 0))});
    TriangleMesh stray = shapes::icosphere(2, 1.0F);
    stray.vertices.push_back(Vec3(1e9F, 0, 0));
    cases.push_back({"stray_vertex", stray});
    return cases;
}

TEST(FeaturesOfAwkwardMeshes, AreFinite) {
    for (const Case& test : awkward_meshes()) {
        SCOPED_TRACE(test.name);
        for (const std::size_t samples : {2U, 100000U}) {
            FeatureOptions options;
            options.samples = samples;
            expect_finite(compute_features(test.mesh, options), test.mesh.face_count());
        }
    }
}

TEST(FeaturesOfAwkwardMeshes, DegenerateFacesDoNotDisturbTheOthers) {
    const TriangleMesh clean = lopsided_torus(24, 16);
    TriangleMesh dirty = clean;
    for (std::uint32_t v = 0; v < 10; ++v) dirty.faces.push_back({v, v, v + 1});
    dirty.source_face_count = static_cast<std::uint32_t>(dirty.face_count());
    FeatureOptions options;
    options.samples = 100000;
    const MeshFeatures a = compute_features(clean, options), b = compute_features(dirty, options);
    for (const char* name :
         {"curvature.k1@0.1", "pca.s1/sum@0.3", "diameter.mean@60", "shape_context.5x6.d3a2", "spin.a3b5"}) {
        const std::span<const float> x = column(a.unary, name), y = column(b.unary, name);
        const auto [low, high] = std::ranges::minmax(x);
        std::size_t different = 0;
        for (std::size_t f = 0; f < x.size(); ++f) different += std::abs(x[f] - y[f]) > 0.02F * (high - low);
        EXPECT_LT(different, x.size() / 20) << name;
    }
}

TEST(FeaturesOfAwkwardMeshes, StayInsideTheirComponent) {
    const TriangleMesh sphere = shapes::icosphere(3, 1.0F);
    const TriangleMesh both = shapes::joined(sphere, shapes::translated(sphere, Vec3(10, 0, 0)));
    FeatureOptions options;
    options.samples = 100000;
    const MeshFeatures one = compute_features(sphere, options), two = compute_features(both, options);
    const std::span<const float> a = column(one.unary, "pca.s1@0.3"), b = column(two.unary, "pca.s1@0.3");
    for (std::size_t f = 0; f < a.size(); ++f) EXPECT_NEAR(a[f], b[f + a.size()], 0.02F);
    // No path leads to the other sphere, so only half of the surface is in reach.
    double sum = 0.0;
    for (std::size_t k = 0; k < two.unary.cols(); ++k) {
        if (two.unary.names[k].starts_with("shape_context.5x4.")) sum += static_cast<double>(two.unary.column(k)[7]);
    }
    EXPECT_GT(sum, 0.45);
    EXPECT_LE(sum, 0.501);
}

TEST(FeaturesOfUnusableInput, Throw) {
    EXPECT_THROW(compute_features(TriangleMesh{}), MeshError);
    TriangleMesh broken = shapes::icosphere(1, 1.0F);
    broken.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(compute_features(broken), MeshError);
    FeatureOptions none;
    none.samples = 0;
    EXPECT_THROW(compute_features(shapes::icosphere(1, 1.0F), none), UsageError);
}

}  // namespace
}  // namespace exemplar
