#include "host/parts/rigging/part_graph.h"

#include <gtest/gtest.h>

#include <numbers>

#include "host/core/errors.h"
#include "tests/parts/rigging/part_shapes.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

using part_shapes::labels_along_x;
using part_shapes::tube;

TEST(PartGraph, ATubeOfThreeLabelsHasTwoRoundBoundaries) {
    const TriangleMesh mesh = tube(12);
    const PartGraph graph = build_part_graph(mesh, build_topology(mesh), labels_along_x(mesh, {4, 9}));
    ASSERT_EQ(graph.parts.size(), 3U);
    ASSERT_EQ(graph.boundaries.size(), 2U);
    const double circumference = 16 * 2 * std::sin(std::numbers::pi / 16);
    for (std::size_t b = 0; b < 2; ++b) {
        EXPECT_NEAR((graph.boundaries[b].center - Vec3(b == 0 ? 4 : 9, 0, 0)).norm(), 0, 1e-4);
        EXPECT_NEAR(graph.boundaries[b].length, circumference, 1e-4);
    }
    double area = 0, expected = 0;
    for (const Part& part : graph.parts) area += part.area;
    for (const float face : face_areas(mesh)) expected += face;
    EXPECT_NEAR(area, expected, 1e-3);
}

TEST(PartGraph, SliversTakeTheLabelAroundThem) {
    const TriangleMesh mesh = tube(12);
    std::vector<std::int32_t> label = labels_along_x(mesh, {6});
    const PartGraph clean = build_part_graph(mesh, build_topology(mesh), label);
    label[40] = 1;                // a face of the other label
    label[300] = label[301] = 0;  // a pair of faces, whose neighbor ...
    label[302] = -1;              // ... is a sliver, too
    EXPECT_EQ(build_part_graph(mesh, build_topology(mesh), label).part_of_face, clean.part_of_face);
}

TEST(PartGraph, PiecesThatNoEdgeConnectsHangOnTheNearestPart) {
    TriangleMesh mesh = tube(12);
    std::vector<std::int32_t> label = labels_along_x(mesh, {6});
    const TriangleMesh hat = tube(2);
    part_shapes::append(mesh, hat, Vec3(13, 0, 0));
    label.insert(label.end(), hat.face_count(), 2);
    const PartGraph graph = build_part_graph(mesh, build_topology(mesh), label);
    ASSERT_EQ(graph.parts.size(), 3U);
    ASSERT_EQ(graph.boundaries.size(), 2U);
    EXPECT_EQ(graph.boundaries[1].part, (std::array<std::uint32_t, 2>{1, 2}));
    EXPECT_EQ(graph.boundaries[1].length, 0);
    EXPECT_NEAR(graph.boundaries[1].center.x(), 12.5, 0.3);
    std::fill(label.end() - static_cast<std::ptrdiff_t>(hat.face_count()), label.end(), 1);
    EXPECT_EQ(build_part_graph(mesh, build_topology(mesh), label).parts.size(), 2U) << "equal labels are one part";
}

TEST(PartGraph, LegsThatTouchAreTwo) {
    // Two tubes that share a seam of one unit: hip 0 at one end, thighs 1 that touch, shanks 2.
    TriangleMesh mesh = tube(12);
    part_shapes::append(mesh, tube(12), Vec3(0, 2, 0));
    std::vector<std::int32_t> label = labels_along_x(mesh, {1, 8});
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)  // weld the corners of the second tube onto the first
        for (std::uint32_t& v : mesh.faces[f])
            for (std::uint32_t w = 0; w < v; ++w)
                if ((mesh.vertices[v] - mesh.vertices[w]).norm() < 1e-4 && mesh.vertices[v].x() < 4) v = w;
    const Topology topology = build_topology(mesh);
    const PartGraph graph = build_part_graph(mesh, topology, label);
    EXPECT_EQ(std::count_if(graph.parts.begin(), graph.parts.end(), [](const Part& p) { return p.label == 1; }), 2);
    EXPECT_EQ(std::count_if(graph.parts.begin(), graph.parts.end(), [](const Part& p) { return p.label == 2; }), 2);
}

TEST(PartGraph, AHeadBetweenTwoEarsIsOne) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    std::vector<std::int32_t> label;
    for (const Vec3& center : face_centers(mesh)) label.push_back(std::abs(center.x()) > 0.92F ? 1 : 0);
    const PartGraph graph = build_part_graph(mesh, build_topology(mesh), label);
    EXPECT_EQ(graph.parts.size(), 3U);
}

TEST(PartGraph, RefusesLabelsOfAnotherMesh) {
    const TriangleMesh mesh = tube(2);
    EXPECT_THROW(build_part_graph(mesh, build_topology(mesh), std::vector<std::int32_t>{0, 1}), UsageError);
}

}  // namespace
}  // namespace exemplar
