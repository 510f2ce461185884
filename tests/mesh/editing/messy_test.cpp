// Meshes as people have them: every measurement must stay finite and sensible on all of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/queries/axes.h"
#include "host/mesh/queries/geodesics.h"
#include "host/mesh/queries/rays.h"
#include "host/mesh/topology.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using testing::SizeIs;

struct MessyMesh {
    std::string name;
    TriangleMesh mesh;
    std::size_t components;
};
void PrintTo(const MessyMesh& messy, std::ostream* out) {
    *out << messy.name;
}

TriangleMesh with_faces(TriangleMesh mesh, const std::vector<Face>& faces) {
    mesh.faces.insert(mesh.faces.end(), faces.begin(), faces.end());
    return mesh;
}
TriangleMesh blob() {
    return shapes::transformed(shapes::icosphere(2, 1), [](const Vec3& p) -> Vec3 {
        return p.cwiseProduct(Vec3(1, 1.4f, 0.8f)) + Vec3(0, 0.1f * std::sin(3 * p.x()), 0);
    });
}
TriangleMesh with_fin() {
    TriangleMesh mesh = blob();
    const Face face = mesh.faces[0];
    mesh.vertices.push_back(2 * mesh.vertices[face[0]]);
    const auto tip = static_cast<std::uint32_t>(mesh.vertex_count() - 1);
    return with_faces(std::move(mesh), {{face[0], face[1], tip}});
}
TriangleMesh with_turned_faces() {
    TriangleMesh mesh = blob();
    for (std::size_t f = 0; f < mesh.face_count(); f += 3) std::swap(mesh.faces[f][0], mesh.faces[f][1]);
    return mesh;
}
TriangleMesh with_copied_faces() {
    TriangleMesh mesh = blob();
    const std::vector<Face> some(mesh.faces.begin(), mesh.faces.begin() + 40);
    return with_faces(std::move(mesh), some);
}
TriangleMesh with_copied_vertices() {  // a polygon soup: every face by itself
    const TriangleMesh mesh = blob();
    TriangleMesh soup;
    for (const Face& face : mesh.faces) {
        const auto first = static_cast<std::uint32_t>(soup.vertex_count());
        for (std::uint32_t v : face) soup.vertices.push_back(mesh.vertices[v]);
        soup.faces.push_back({first, first + 1, first + 2});
    }
    return soup;
}
TriangleMesh with_flat_faces() {
    TriangleMesh mesh = blob();
    mesh.vertices.push_back((mesh.vertices[0] + mesh.vertices[1]) / 2);
    const auto middle = static_cast<std::uint32_t>(mesh.vertex_count() - 1);
    return with_faces(std::move(mesh), {{0, 1, middle}, {2, 2, 3}, {4, 4, 4}, {0, 1, 0}});
}
TriangleMesh with_lone_vertices() {
    TriangleMesh mesh = blob();
    mesh.vertices.insert(mesh.vertices.begin(), {{1e6f, 0, 0}, {0, -1e6f, 0}});
    for (Face& face : mesh.faces)
        for (std::uint32_t& v : face) v += 2;
    return mesh;
}
TriangleMesh single_face(const Vec3& a, const Vec3& b, const Vec3& c) {
    TriangleMesh mesh;
    mesh.vertices = {a, b, c};
    mesh.faces = {{0, 1, 2}};
    return mesh;
}

std::vector<MessyMesh> messy_meshes() {
    TriangleMesh open = blob();
    open.faces.resize(200);
    return {{"three_faces_on_an_edge", with_fin(), 1},
            {"turned_faces", with_turned_faces(), 1},
            {"copied_faces", with_copied_faces(), 1},
            {"copied_vertices", with_copied_vertices(), 320},
            {"flat_faces", with_flat_faces(), 4},
            {"lone_vertices", with_lone_vertices(), 1},
            {"several_components", shapes::joined(blob(), shapes::translated(blob(), {5, 0, 0})), 2},
            {"open_boundary", shapes::grid(7, 5, 1), 1},
            {"holes", open, 0},
            {"one_face", single_face({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 1},
            {"one_flat_face", single_face({3, 3, 3}, {4, 4, 4}, {5, 5, 5}), 1},
            {"one_point", single_face({3, 3, 3}, {3, 3, 3}, {3, 3, 3}), 1},
            {"micrometer", shapes::scaled(blob(), 1e-6f), 1},
            {"megameter", shapes::scaled(blob(), 1e6f), 1},
            {"far_away", shapes::translated(shapes::scaled(blob(), 100), {1e5f, -1e5f, 1e5f}), 1},
            {"one_face_far_away", single_face({1e5f, 1e5f, 0}, {1e5f + 1, 1e5f, 0}, {1e5f, 1e5f + 1, 0}), 1}};
}

class Messy : public testing::TestWithParam<MessyMesh> {
  protected:
    const TriangleMesh& mesh() const { return GetParam().mesh; }
    /// Largest extent of what the faces refer to.
    float size() const {
        Eigen::AlignedBox3f box;
        for (const Face& face : mesh().faces)
            for (std::uint32_t v : face) box.extend(mesh().vertices[v]);
        return box.diagonal().norm();
    }
};

TEST_P(Messy, IsUsableAndItsTopologyIsWhole) {
    const MeshReport report = validate_mesh(mesh());
    EXPECT_TRUE(report.usable());
    for (const std::string& line : report.messages()) EXPECT_EQ(line.find('\n'), std::string::npos);
    const Topology topology = build_topology(mesh());
    for (const Edge& edge : topology.edges) {
        EXPECT_LT(edge.vertex[0], edge.vertex[1]);
        EXPECT_LT(edge.face[0], mesh().face_count());
    }
    const std::vector<std::uint32_t> component = face_components(mesh(), topology);
    ASSERT_THAT(component, SizeIs(mesh().face_count()));
    if (GetParam().components) {
        EXPECT_EQ(report.components, GetParam().components);
    }
    for (float angle : exterior_dihedral_angles(mesh(), topology)) {
        EXPECT_GE(angle, 0);
        EXPECT_LE(angle, 2 * std::numbers::pi_v<float> + 1e-5f);
    }
}

TEST_P(Messy, NormalsAndAreasAreSound) {
    for (const Vec3& n : face_normals(mesh())) EXPECT_NEAR(n.norm(), 1, 1e-5);
    for (const Vec3& n : vertex_normals(mesh())) EXPECT_NEAR(n.norm(), 1, 1e-5);
    double total = 0;
    for (float area : face_areas(mesh())) {
        EXPECT_TRUE(std::isfinite(area) && area >= 0);
        total += area;
    }
    EXPECT_LE(total, 8 * double(size()) * double(size()));
    EXPECT_TRUE(area_centroid(mesh()).allFinite());
}

TEST_P(Messy, CurvatureIsFinite) {
    const VertexCurvature c = estimate_curvature(mesh(), true);
    ASSERT_THAT(c.k1, SizeIs(mesh().vertex_count()));
    for (std::size_t v = 0; v < mesh().vertex_count(); ++v) {
        EXPECT_TRUE(std::isfinite(c.k1[v]) && std::isfinite(c.k2[v])) << v;
        EXPECT_GE(c.k1[v], c.k2[v]) << v;
        EXPECT_NEAR(c.e1[v].norm(), 1, 1e-4) << v;
        EXPECT_NEAR(c.e1[v].dot(c.e2[v]), 0, 1e-4) << v;
        for (float d : c.derivative[v]) EXPECT_TRUE(std::isfinite(d)) << v;
    }
}

TEST_P(Messy, DistancesAndSamplesAreSound) {
    const Topology topology = build_topology(mesh());
    const std::vector<std::uint32_t> component = face_components(mesh(), topology);
    const DualGraph graph = build_dual_graph(mesh(), topology);
    std::vector<float> distance(mesh().face_count());
    GeodesicSearch(graph).distances(0, distance);
    for (std::size_t f = 0; f < distance.size(); ++f) {
        EXPECT_EQ(std::isfinite(distance[f]), component[f] == component[0]) << f;
        EXPECT_GE(distance[f], 0) << f;
        EXPECT_LE(component[f] == component[0] ? distance[f] : 0, 6 * size()) << f;
    }
    for (std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{50}, mesh().face_count()}) {
        const FaceSamples samples = sample_faces(mesh(), graph, count);
        EXPECT_THAT(samples.face, SizeIs(std::min(count, mesh().face_count())));
        const double sum = std::accumulate(samples.area_share.begin(), samples.area_share.end(), 0.0);
        EXPECT_NEAR(sum, 1, 1e-4) << count;
    }
}

TEST_P(Messy, RaysHitWithinTheMesh) {
    const RayScene scene(mesh());
    const std::vector<Vec3> centers = face_centers(mesh()), normals = face_normals(mesh());
    std::size_t hits = 0;
    for (std::uint32_t f = 0; f < mesh().face_count(); ++f) {
        const auto hit = scene.first_hit_from(f, centers[f], -normals[f]);
        if (!hit) continue;
        ++hits;
        EXPECT_NE(hit->face, f);
        EXPECT_GT(hit->distance, 0);
        EXPECT_LE(hit->distance, 1.001f * size());
    }
    // Of a closed surface every ray inward hits the other side.
    const MeshReport report = validate_mesh(mesh());
    const bool closed = report.boundary_edges == 0 && report.inconsistent_edges.empty();
    if (closed && mesh().face_count() > 4) {
        EXPECT_EQ(hits, mesh().face_count());
    }
}

TEST_P(Messy, AxesAndPlanesAreOrthonormal) {
    const PrincipalAxes axes = principal_axes(mesh());
    EXPECT_TRUE(axes.center.allFinite());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(axes.axis[i].norm(), 1, 1e-4);
        EXPECT_NEAR(axes.axis[i].dot(axes.axis[(i + 1) % 3]), 0, 1e-4);
        EXPECT_TRUE(axes.sigma[i] >= 0 && axes.sigma[i] <= size());
    }
    const std::vector<SymmetryPlane> planes = symmetry_planes(mesh());
    ASSERT_THAT(planes, SizeIs(3));
    for (const SymmetryPlane& plane : planes) {
        EXPECT_TRUE(plane.point.allFinite());
        EXPECT_NEAR(plane.normal.norm(), 1, 1e-4);
        EXPECT_TRUE(plane.error >= 0 && plane.error <= 1) << plane.error;
    }
}

INSTANTIATE_TEST_SUITE_P(AllKinds, Messy, testing::ValuesIn(messy_meshes()),
                         [](const auto& messy) { return messy.param.name; });

/// The measurements of a mesh do not change, but for its unit, when it is scaled.
TEST(MessyScale, CurvatureRaysAndPlanesFollowTheUnit) {
    const TriangleMesh mesh = blob();
    const VertexCurvature reference = estimate_curvature(mesh, false);
    const std::vector<Vec3> centers = face_centers(mesh), normals = face_normals(mesh);
    const RayScene scene(mesh);
    const std::vector<SymmetryPlane> planes = symmetry_planes(mesh);
    for (float unit : {1e-6f, 1e-3f, 1e3f, 1e6f}) {
        const TriangleMesh scaled = shapes::scaled(mesh, unit);
        const VertexCurvature c = estimate_curvature(scaled, false);
        for (std::size_t v = 0; v < mesh.vertex_count(); ++v)
            ASSERT_NEAR(c.k1[v] * unit, reference.k1[v], 1e-3 * std::abs(reference.k1[v]) + 1e-3) << unit;
        const RayScene scaled_scene(scaled);
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
            const auto a = scene.first_hit_from(f, centers[f], -normals[f]);
            const auto b = scaled_scene.first_hit_from(f, centers[f] * unit, -normals[f]);
            ASSERT_TRUE(a && b) << unit << " face " << f;
            ASSERT_NEAR(b->distance / unit, a->distance, 1e-3f * a->distance) << unit;
        }
        const std::vector<SymmetryPlane> same = symmetry_planes(scaled);
        EXPECT_NEAR(std::abs(same[0].normal.dot(planes[0].normal)), 1, 1e-3) << unit;
        EXPECT_NEAR(same[0].error, planes[0].error, 1e-4) << unit;
    }
}

}  // namespace
}  // namespace exemplar
