#include "host/mesh/editing/validate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "host/core/errors.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::UnorderedElementsAre;

using Pair = std::array<std::uint32_t, 2>;

/// The one message that holds `word`.
std::string message_with(const MeshReport& report, const std::string& word) {
    std::vector<std::string> found;
    for (const std::string& line : report.messages())
        if (line.find(word) != std::string::npos) found.push_back(line);
    EXPECT_THAT(found, SizeIs(1)) << word;
    return found.empty() ? "" : found.front();
}

TEST(Validate, ClosedSurfacesAreClean) {
    for (const TriangleMesh& mesh : {shapes::icosphere(2, 1), shapes::torus(2, 0.5f, 9, 7), shapes::box(1, 2, 3, 3)}) {
        const MeshReport report = validate_mesh(mesh);
        EXPECT_TRUE(report.clean());
        EXPECT_TRUE(report.usable());
        EXPECT_EQ(report.boundary_edges, 0u);
        EXPECT_EQ(report.components, 1u);
        EXPECT_THAT(report.messages(), IsEmpty());
    }
}

TEST(Validate, OpenSurfacesAndPartsAreCleanButMentioned) {
    const MeshReport report = validate_mesh(shapes::joined(shapes::grid(3, 2, 1), shapes::grid(1, 1, 1)));
    EXPECT_TRUE(report.clean());
    EXPECT_EQ(report.boundary_edges, 14u);
    EXPECT_EQ(report.components, 2u);
    EXPECT_THAT(message_with(report, "boundary"), HasSubstr("14 boundary edges"));
    EXPECT_THAT(message_with(report, "components"), HasSubstr("2 connected components"));
}

TEST(Validate, EmptyMeshesAreUnusable) {
    const MeshReport report = validate_mesh({});
    EXPECT_TRUE(report.empty);
    EXPECT_FALSE(report.usable());
    EXPECT_FALSE(report.clean());
    EXPECT_EQ(report.components, 0u);
    EXPECT_FALSE(report.inside_out);
    TriangleMesh points;
    points.vertices = {{0, 0, 0}};
    EXPECT_TRUE(validate_mesh(points).empty);
}

TEST(Validate, NonFiniteVertices) {
    TriangleMesh mesh = shapes::icosphere(1, 1);
    mesh.vertices[3].y() = std::numeric_limits<float>::quiet_NaN();
    mesh.vertices[7].z() = -std::numeric_limits<float>::infinity();
    const MeshReport report = validate_mesh(mesh);
    EXPECT_THAT(report.non_finite_vertices, ElementsAre(3u, 7u));
    EXPECT_THAT(report.degenerate_faces, IsEmpty());
    EXPECT_FALSE(report.usable());
    EXPECT_THAT(message_with(report, "finite"), HasSubstr("2 vertices are not finite (3, 7)"));
}

TEST(Validate, NonManifoldEdgesAreListedOnce) {
    // Four pages on one spine.
    TriangleMesh book;
    book.vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    book.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}};
    const MeshReport report = validate_mesh(book);
    EXPECT_THAT(report.non_manifold_edges, ElementsAre(Pair{0, 1}));
    EXPECT_THAT(report.inconsistent_edges, IsEmpty());
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.boundary_edges, 8u);
    EXPECT_FALSE(report.clean());
    EXPECT_THAT(message_with(report, "more than two faces"), HasSubstr("1 edge with more than two faces (0-1)"));
}

TEST(Validate, InconsistentEdgesAreThoseOfTheTurnedFace) {
    TriangleMesh mesh = shapes::icosphere(1, 1);
    Face& turned = mesh.faces[11];
    std::swap(turned[0], turned[1]);
    const auto edge = [&](int i) {
        const auto [low, high] = std::minmax(turned[i], turned[(i + 1) % 3]);
        return Pair{low, high};
    };
    const MeshReport report = validate_mesh(mesh);
    EXPECT_THAT(report.inconsistent_edges, UnorderedElementsAre(edge(0), edge(1), edge(2)));
    EXPECT_THAT(report.non_manifold_edges, IsEmpty());
    EXPECT_FALSE(report.inside_out);
    EXPECT_THAT(message_with(report, "orientation"), HasSubstr("3 edges between faces of opposite orientation"));
}

TEST(Validate, InsideOutOnlyIfClosedConsistentAndNegative) {
    const auto reversed = [](TriangleMesh mesh) {
        for (Face& f : mesh.faces) std::swap(f[0], f[1]);
        return mesh;
    };
    // Far from the origin too.
    const TriangleMesh sphere = shapes::translated(shapes::icosphere(1, 1), {50, -20, 3});
    EXPECT_FALSE(validate_mesh(sphere).inside_out);
    const MeshReport report = validate_mesh(reversed(sphere));
    EXPECT_TRUE(report.inside_out);
    EXPECT_FALSE(report.clean());
    EXPECT_TRUE(report.usable());
    EXPECT_THAT(message_with(report, "inside out"), HasSubstr("reverse all faces"));
    TriangleMesh open = reversed(sphere);
    open.faces.pop_back();
    EXPECT_FALSE(validate_mesh(open).inside_out);
    EXPECT_FALSE(validate_mesh(reversed(shapes::grid(2, 2, 1))).inside_out);
}

TEST(Validate, DegenerateFaces) {
    TriangleMesh mesh = shapes::grid(1, 1, 2);  // vertices 0 .. 3
    mesh.vertices.push_back({1, 0, 0});         // 4, between 0 and 1
    mesh.faces.push_back({0, 4, 1});            // in one line
    mesh.faces.push_back({3, 3, 4});            // repeated vertices, in every place
    mesh.faces.push_back({4, 3, 3});
    mesh.faces.push_back({3, 4, 3});
    mesh.faces.push_back({2, 2, 2});
    const MeshReport report = validate_mesh(mesh);
    EXPECT_THAT(report.degenerate_faces, ElementsAre(2u, 3u, 4u, 5u, 6u));
    EXPECT_THAT(report.inconsistent_edges, IsEmpty());
    EXPECT_THAT(message_with(report, "without area"), HasSubstr("5 faces without area (2, 3, 4, 5, 6)"));
}

TEST(Validate, TinyFacesAreNotDegenerate) {
    EXPECT_TRUE(validate_mesh(shapes::scaled(shapes::icosphere(1, 1), 1e-18f)).clean());
    EXPECT_TRUE(validate_mesh(shapes::scaled(shapes::icosphere(1, 1), 1e18f)).clean());
}

TEST(Validate, DuplicateFacesInAnyOrder) {
    TriangleMesh mesh = shapes::grid(2, 2, 1);
    const Face f = mesh.faces[2];
    mesh.faces.push_back({f[2], f[1], f[0]});
    mesh.faces.push_back({f[1], f[2], f[0]});
    const MeshReport report = validate_mesh(mesh);
    EXPECT_THAT(report.duplicate_faces, ElementsAre(8u, 9u));
    EXPECT_THAT(message_with(report, "earlier"), HasSubstr("(8, 9)"));
}

TEST(Validate, UnreferencedVertices) {
    TriangleMesh mesh = shapes::icosphere(0, 1);
    for (int i = 0; i < 7; ++i) mesh.vertices.push_back({0, 0, 0});
    const MeshReport report = validate_mesh(mesh);
    EXPECT_THAT(report.unreferenced_vertices, ElementsAre(12u, 13u, 14u, 15u, 16u, 17u, 18u));
    EXPECT_FALSE(report.clean());
    EXPECT_THAT(message_with(report, "without a face"),
                HasSubstr("7 vertices without a face (12, 13, 14, 15, 16, ...)"));
}

TEST(Validate, ResultsDoNotDependOnFaceOrder) {
    TriangleMesh mesh = shapes::joined(shapes::icosphere(1, 1), shapes::grid(2, 3, 1));
    std::swap(mesh.faces[5][0], mesh.faces[5][1]);
    const MeshReport expected = validate_mesh(mesh);
    for (std::uint64_t seed = 1; seed < 4; ++seed) {
        const MeshReport report = validate_mesh(shapes::with_shuffled_faces(mesh, seed));
        EXPECT_EQ(report.inconsistent_edges, expected.inconsistent_edges);
        EXPECT_EQ(report.boundary_edges, expected.boundary_edges);
        EXPECT_EQ(report.components, expected.components);
    }
}

TEST(Validate, RequireUsableNamesTheMesh) {
    EXPECT_THAT(mesh_files::error_of<MeshError>([] { require_usable({}, "x.off"); }),
                AllOf(HasSubstr("x.off: "), HasSubstr("no faces")));
    TriangleMesh mesh = shapes::icosphere(0, 1);
    EXPECT_TRUE(require_usable(mesh, "x.off").clean());
    mesh.vertices[1].x() = INFINITY;
    EXPECT_THAT(mesh_files::error_of<MeshError>([&] { require_usable(mesh, "x.off"); }),
                AllOf(HasSubstr("x.off: 1 vertex"), Not(HasSubstr("\n"))));
}

TEST(Validate, RefusesSizesWhosePowersFloatsCannotHold) {
    const auto message = [](float size) {
        return mesh_files::error_of<MeshError>(
            [&] { require_drawable(shapes::scaled(shapes::icosphere(1, 1), size), "x.off"); });
    };
    EXPECT_THAT(message(1e13F),
                AllOf(HasSubstr("x.off: the mesh is too large (3.5e+13 across)"), HasSubstr("scale it")));
    EXPECT_THAT(message(3e38F), HasSubstr("too large"));
    EXPECT_THAT(message(1e-13F),
                AllOf(HasSubstr("x.off: the mesh is too small (3.5e-13 across)"), HasSubstr("scale it")));
    EXPECT_THAT(message(3e-43F), HasSubstr("too small"));
    for (const float size : {1e-6F, 1e-11F, 1e6F, 1e11F})
        EXPECT_TRUE(require_drawable(shapes::scaled(shapes::icosphere(1, 1), size), "x.off").clean()) << size;
    for (const float size : {1e-18F, 1e-13F, 1e13F, 1e18F})
        EXPECT_TRUE(require_usable(shapes::scaled(shapes::icosphere(1, 1), size), "x.off").clean()) << size;
    for (const float size : {3e-43F, 1e20F})
        EXPECT_THROW(require_usable(shapes::scaled(shapes::icosphere(1, 1), size), "x.off"), MeshError) << size;
    TriangleMesh loose = shapes::icosphere(1, 1);
    loose.vertices.push_back({3e38F, 0, 0});
    EXPECT_TRUE(size_fault(loose, k_usable_sizes).empty()) << "vertices without a face do not count";
}

}  // namespace
}  // namespace exemplar
