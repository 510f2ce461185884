#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "host/mesh/topology.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using std::numbers::pi;

std::array<std::uint32_t, 4> flat(const Edge& e) {
    return {e.vertex[0], e.vertex[1], e.face[0], e.face[1]};
}

/// Edges by the definition, with a map of sets.
std::vector<std::array<std::uint32_t, 4>> naive_edges(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<std::uint32_t>> faces;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
            if (a != b) faces[{std::min(a, b), std::max(a, b)}].insert(f);
        }
    std::vector<std::array<std::uint32_t, 4>> edges;
    for (const auto& [vertex, around] : faces) {
        if (around.size() == 1) edges.push_back({vertex.first, vertex.second, *around.begin(), k_invalid_index});
        for (auto it = around.begin(); std::next(it) != around.end(); ++it)
            edges.push_back({vertex.first, vertex.second, *it, *std::next(it)});
    }
    return edges;
}

void expect_consistent(const TriangleMesh& mesh, const Topology& topology) {
    std::vector<std::array<std::uint32_t, 4>> edges;
    for (const Edge& e : topology.edges) edges.push_back(flat(e));
    EXPECT_EQ(edges, naive_edges(mesh));
    ASSERT_EQ(topology.face_edge_begin.size(), mesh.face_count() + 1);
    ASSERT_EQ(topology.vertex_face_begin.size(), mesh.vertex_count() + 1);
    std::vector<std::set<std::uint32_t>> edges_of(mesh.face_count()), faces_of(mesh.vertex_count());
    for (std::uint32_t e = 0; e < topology.edges.size(); ++e)
        for (std::uint32_t f : topology.edges[e].face)
            if (f != k_invalid_index) edges_of[f].insert(e);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        for (std::uint32_t v : mesh.faces[f]) faces_of[v].insert(f);
        EXPECT_THAT(topology.edges_of_face(f), testing::UnorderedElementsAreArray(edges_of[f]));
    }
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v)
        EXPECT_THAT(topology.faces_of_vertex(v), testing::ElementsAreArray(faces_of[v]));
}

TEST(Topology, SatisfiesEulerOnClosedSurfaces) {
    for (const auto& [mesh, characteristic] : {std::pair{shapes::icosphere(3, 1), 2},
                                               {shapes::torus(3, 1, 20, 9), 0},
                                               {shapes::cylinder(1, 2, 11, 3, true), 2},
                                               {shapes::box(1, 2, 3, 4), 2}}) {
        const Topology topology = build_topology(mesh);
        EXPECT_EQ(static_cast<int>(mesh.vertex_count() + mesh.face_count()) - static_cast<int>(topology.edges.size()),
                  characteristic);
        EXPECT_TRUE(std::ranges::none_of(topology.edges, &Edge::is_boundary));
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(topology.edges_of_face(f).size(), 3u);
    }
}

TEST(Topology, CountsTheBoundaryOfOpenSurfaces) {
    EXPECT_EQ(std::ranges::count_if(build_topology(shapes::grid(5, 3, 1)).edges, &Edge::is_boundary), 16);
    EXPECT_EQ(std::ranges::count_if(build_topology(shapes::cylinder(1, 2, 9, 4, false)).edges, &Edge::is_boundary), 18);
}

TEST(Topology, EqualsTheDefinitionOnRandomFaces) {
    // Random indices give non-manifold edges, repeated vertices, duplicate faces and lone vertices in plenty.
    Random random(7);
    for (int round = 0; round < 300; ++round) {
        TriangleMesh mesh;
        mesh.vertices.assign(1 + random.index(9), Vec3::Zero());
        const std::size_t faces = random.index(25);
        for (std::size_t f = 0; f < faces; ++f) {
            Face face;
            for (std::uint32_t& v : face) v = static_cast<std::uint32_t>(random.index(mesh.vertex_count()));
            mesh.faces.push_back(face);
        }
        expect_consistent(mesh, build_topology(mesh));
    }
}

TEST(Topology, OfAnEmptyMeshIsEmpty) {
    const Topology topology = build_topology({});
    EXPECT_TRUE(topology.edges.empty());
    EXPECT_EQ(topology.face_edge_begin.size(), 1u);
    EXPECT_TRUE(face_components({}, topology).empty());
}

TEST(FaceComponents, AreNumberedByFirstFace) {
    const TriangleMesh two = shapes::joined(shapes::icosphere(1, 1), shapes::box(1, 1, 1, 2));
    std::vector<std::uint32_t> permutation;
    const TriangleMesh mesh = shapes::with_shuffled_faces(two, 5, &permutation);
    const std::vector<std::uint32_t> component = face_components(mesh, build_topology(mesh));
    const auto truth = [&](std::size_t i) { return (permutation[i] < 80) == (permutation[0] < 80) ? 0u : 1u; };
    for (std::size_t i = 0; i < component.size(); ++i) EXPECT_EQ(component[i], truth(i));
}

TEST(FaceComponents, TouchingInAVertexAreApartAndNonManifoldEdgesJoin) {
    TriangleMesh mesh;
    mesh.vertices.assign(7, Vec3::Zero());
    mesh.faces = {{0, 1, 2}, {2, 3, 4}, {1, 0, 5}, {0, 1, 6}};
    EXPECT_THAT(face_components(mesh, build_topology(mesh)), testing::ElementsAre(0, 1, 0, 0));
}

/// The exterior dihedral angles of two triangles on the edge from the origin to +y: the first to -x in the plane z = 0
/// (normal +z), the second turned down by `bend` from +x.
float angle_of_hinge(double bend, bool flip_second = false) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}, shapes::detail::vec3(std::cos(bend), 0, -std::sin(bend))};
    mesh.faces = {{0, 1, 2}, flip_second ? Face{3, 0, 1} : Face{3, 1, 0}};
    const Topology topology = build_topology(mesh);
    const std::vector<float> angles = exterior_dihedral_angles(mesh, topology);
    for (std::size_t e = 0; e < angles.size(); ++e)
        if (!topology.edges[e].is_boundary()) return angles[e];
    return -1;
}

TEST(ExteriorDihedralAngles, FollowTheBend) {
    for (double bend = -3.1; bend <= 3.1; bend += 0.1) {
        EXPECT_NEAR(angle_of_hinge(bend), pi + bend, 1e-5) << bend;
        EXPECT_NEAR(angle_of_hinge(bend, true), pi + bend, 1e-5) << "flipped neighbor, " << bend;
    }
    EXPECT_NEAR(angle_of_hinge(pi), 2 * pi, 1e-5);
}

TEST(ExteriorDihedralAngles, OfACubeAreFlatOrThreeHalvesPi) {
    TriangleMesh mesh = shapes::box(1, 1, 1, 1);
    const auto count = [&](double angle) {
        return std::ranges::count_if(exterior_dihedral_angles(mesh, build_topology(mesh)),
                                     [&](float a) { return std::abs(a - angle) < 1e-5; });
    };
    EXPECT_EQ(count(pi), 6);
    EXPECT_EQ(count(1.5 * pi), 12);
    for (Face& face : mesh.faces) std::swap(face[0], face[1]);
    EXPECT_EQ(count(0.5 * pi), 12) << "inside out, every edge is concave";
}

TEST(ExteriorDihedralAngles, AtBoundariesAndDegenerateFacesAreFlat) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 0, 0}};
    mesh.faces = {{0, 1, 2}, {1, 0, 3}, {0, 2, 2}};
    for (float angle : exterior_dihedral_angles(mesh, build_topology(mesh))) EXPECT_FLOAT_EQ(angle, float(pi));
}

}  // namespace
}  // namespace exemplar
