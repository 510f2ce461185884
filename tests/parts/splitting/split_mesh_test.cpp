#include "host/parts/splitting/split_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/mesh/topology.h"
#include "host/parts/splitting/part_check.h"
#include "tests/support/manifold.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

std::vector<std::uint32_t> divide(const TriangleMesh& mesh, const std::function<std::uint32_t(const Vec3&)>& part) {
    std::vector<std::uint32_t> parts;
    for (const Vec3& center : face_centers(mesh)) parts.push_back(part(center));
    return parts;
}

/// Checks that all parts are closed and manifold and that their volumes add up.
void expect_closed_parts(const TriangleMesh& mesh, const SplitMesh& split) {
    double volume = 0;
    for (const PartMesh& part : split.parts) {
        if (part.mesh.faces.empty()) continue;
        EXPECT_TRUE(is_closed_and_oriented(part.mesh));
        EXPECT_TRUE(is_vertex_manifold(part.mesh));
        const PartCheck check = check_part(part.mesh);
        EXPECT_TRUE(check.is_closed());
        EXPECT_TRUE(check.is_manifold());
        volume += check.volume;
    }
    EXPECT_EQ(split.open_edges, 0u);
    EXPECT_NEAR(volume, signed_volume(mesh), 1e-4 * std::abs(signed_volume(mesh)));
}

TEST(SplitMesh, PartsHoldTheTrianglesWithEqualCoordinates) {
    const TriangleMesh mesh = shapes::torus(1, 0.3f, 20, 12);
    const auto part = divide(mesh, [](const Vec3& p) { return p.x() > 0.1f ? 0u : p.y() > 0 ? 1u : 3u; });
    for (const bool caps : {false, true}) {
        const SplitMesh split = split_mesh(mesh, part, 4, {caps});
        ASSERT_EQ(split.parts.size(), 4u);
        EXPECT_TRUE(split.parts[2].mesh.faces.empty());
        std::set<std::uint32_t> seen;
        for (std::uint32_t p = 0; p < 4; ++p) {
            const PartMesh& found = split.parts[p];
            ASSERT_EQ(found.face_of.size(), found.mesh.face_count());
            for (std::size_t f = 0; f < found.face_of.size(); ++f) {
                if (found.face_of[f] == k_invalid_index) continue;
                EXPECT_EQ(part[found.face_of[f]], p);
                EXPECT_TRUE(seen.insert(found.face_of[f]).second);
                for (std::size_t i = 0; i < 3; ++i)
                    EXPECT_EQ(found.mesh.vertices[found.mesh.faces[f][i]],
                              mesh.vertices[mesh.faces[found.face_of[f]][i]]);
            }
            EXPECT_EQ(found.cap_faces > 0, caps && p != 2);
        }
        EXPECT_EQ(seen.size(), mesh.face_count());
    }
}

TEST(SplitMesh, HalfABoxIsHalfItsVolume) {
    const TriangleMesh mesh = shapes::box(2, 1, 1, 4);
    const auto part = divide(mesh, [](const Vec3& p) { return p.x() > 0 ? 1u : 0u; });
    const SplitMesh split = split_mesh(mesh, part, 2, {true});
    expect_closed_parts(mesh, split);
    EXPECT_EQ(split.caps, 1u);
    EXPECT_EQ(split.cap_centers, 0u);
    for (const PartMesh& half : split.parts) {
        EXPECT_NEAR(check_part(half.mesh).volume, 1, 1e-6);
        EXPECT_EQ(half.cap_faces, 14u) << "a loop of 16 edges";
        const std::vector<float> areas = face_areas(half.mesh);
        double cap_area = 0;
        for (std::size_t f = 0; f < areas.size(); ++f)
            if (half.face_of[f] == k_invalid_index) cap_area += areas[f];
        EXPECT_NEAR(cap_area, 1, 1e-6) << "flat, without folds";
    }
}

TEST(SplitMesh, CapsOfTwoPartsAreMirrorImages) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const auto part = divide(mesh, [](const Vec3& p) { return p.x() + 0.3f * p.y() > 0.2f ? 1u : 0u; });
    const SplitMesh split = split_mesh(mesh, part, 2, {true});
    expect_closed_parts(mesh, split);
    using Point = std::array<float, 3>;
    std::array<std::multiset<std::set<Point>>, 2> caps;
    for (std::size_t p = 0; p < 2; ++p)
        for (std::size_t f = 0; f < split.parts[p].face_of.size(); ++f) {
            if (split.parts[p].face_of[f] != k_invalid_index) continue;
            std::set<Point> corners;
            for (const std::uint32_t v : split.parts[p].mesh.faces[f]) {
                const Vec3& q = split.parts[p].mesh.vertices[v];
                corners.insert({q.x(), q.y(), q.z()});
            }
            caps[p].insert(corners);
        }
    EXPECT_FALSE(caps[0].empty());
    EXPECT_EQ(caps[0], caps[1]);
}

TEST(SplitMesh, ThreePartsThatMeetAreClosed) {
    const TriangleMesh mesh = shapes::icosphere(3, 1);
    const auto part = divide(mesh, [](const Vec3& p) {
        return p.z() < -0.2f ? 0u : std::atan2(p.y(), p.x()) > 0 ? 1u : 2u;
    });
    expect_closed_parts(mesh, split_mesh(mesh, part, 3, {true}));
}

TEST(SplitMesh, CheckerboardsThatTouchAtVerticesAreClosed) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 6);
    const auto part = divide(mesh, [](const Vec3& p) {
        const auto cell = [](float x) { return static_cast<int>(std::floor((x + 0.5f) * 2.999f)); };
        return static_cast<std::uint32_t>((cell(p.x()) + cell(p.y()) + cell(p.z())) % 2);
    });
    expect_closed_parts(mesh, split_mesh(mesh, part, 2, {true}));
}

TEST(SplitMesh, AnyLabelingOfAClosedSurfaceIsClosed) {
    for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Random random(seed);
        const TriangleMesh mesh = seed % 2 ? shapes::icosphere(2, 1) : shapes::torus(1, 0.4f, 14, 9);
        const std::uint32_t count = 2 + static_cast<std::uint32_t>(random.index(5));
        std::vector<std::uint32_t> part(mesh.face_count());
        if (seed % 3 == 0) {  // noise: parts of single triangles
            for (std::uint32_t& p : part) p = static_cast<std::uint32_t>(random.index(count));
        } else {
            std::vector<Vec3> seeds;
            for (std::uint32_t i = 0; i < count; ++i)
                seeds.push_back(mesh.vertices[static_cast<std::size_t>(random.index(mesh.vertex_count()))]);
            part = divide(mesh, [&](const Vec3& p) {
                std::uint32_t best = 0;
                for (std::uint32_t i = 1; i < count; ++i)
                    if ((p - seeds[i]).norm() < (p - seeds[best]).norm()) best = i;
                return best;
            });
        }
        SCOPED_TRACE(seed);
        expect_closed_parts(mesh, split_mesh(mesh, part, count, {true}));
    }
}

TEST(SplitMesh, LongLoopsAreDivided) {
    const TriangleMesh mesh = shapes::cylinder(1, 2, 700, 4, true);
    const auto part = divide(mesh, [](const Vec3& p) { return p.z() > 0 ? 1u : 0u; });
    const SplitMesh split = split_mesh(mesh, part, 2, {true});
    expect_closed_parts(mesh, split);
    EXPECT_EQ(split.cap_centers, 0u);
    EXPECT_EQ(split.parts[0].cap_faces, 698u);
}

TEST(SplitMesh, CutsThatEndAtABoundaryStayOpen) {
    const TriangleMesh mesh = shapes::grid(4, 4, 1);
    const float middle = area_centroid(mesh).x();
    const auto part = divide(mesh, [&](const Vec3& p) { return p.x() > middle ? 1u : 0u; });
    const SplitMesh split = split_mesh(mesh, part, 2, {true});
    EXPECT_EQ(split.caps, 0u);
    EXPECT_EQ(split.open_edges, 4u);
    EXPECT_EQ(split.parts[0].mesh.face_count() + split.parts[1].mesh.face_count(), mesh.face_count());
}

TEST(SplitMesh, NonManifoldMeshesKeepTheirConnections) {
    TriangleMesh mesh = shapes::box(1, 1, 1, 1);
    mesh.vertices.push_back(Vec3(3, 3, 3));
    mesh.faces.push_back({mesh.faces[0][0], mesh.faces[0][1], 8});
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    const std::vector<std::uint32_t> part(mesh.face_count(), 0);
    const SplitMesh split = split_mesh(mesh, part, 1, {true});
    EXPECT_EQ(split.parts[0].mesh.vertex_count(), 9u);
    EXPECT_EQ(check_part(split.parts[0].mesh).irregular_edges, 1u);
}

TEST(SplitMesh, RefusesNumbersThatDoNotFit) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 1);
    EXPECT_THROW(split_mesh(mesh, std::vector<std::uint32_t>(3, 0), 1), UsageError);
    EXPECT_THROW(split_mesh(mesh, std::vector<std::uint32_t>(mesh.face_count(), 1), 1), UsageError);
}

TEST(ExplodeParts, MovesPartsApartAndKeepsTheirShape) {
    const TriangleMesh mesh = shapes::box(3, 1, 1, 3);
    const auto part = divide(mesh, [](const Vec3& p) { return p.x() < -0.5f ? 0u : p.x() < 0.5f ? 1u : 2u; });
    SplitMesh split = split_mesh(mesh, part, 3, {true});
    const SplitMesh before = split;
    explode_parts(split.parts, 0.2);
    const double offset = 0.2 * std::sqrt(11.0);
    for (std::size_t p = 0; p < 3; ++p)
        for (std::size_t v = 0; v < split.parts[p].mesh.vertex_count(); ++v) {
            const Vec3 moved = split.parts[p].mesh.vertices[v] - before.parts[p].mesh.vertices[v];
            EXPECT_NEAR(moved.x(), (static_cast<double>(p) - 1) * offset, 1e-5);
            EXPECT_NEAR(moved.tail<2>().norm(), 0, 1e-5);
        }
}

TEST(CheckPart, TellsDefects) {
    EXPECT_EQ(check_part(shapes::grid(2, 2, 1)).boundary_edges, 8u);
    EXPECT_NEAR(check_part(shapes::box(1, 2, 3, 2)).volume, 6, 1e-5);
    TriangleMesh twice = shapes::box(1, 1, 1, 1);
    const TriangleMesh moved = shapes::translated(twice, Vec3(1, 1, 1));
    twice = shapes::joined(twice, moved);
    for (Face& face : twice.faces)
        for (std::uint32_t& corner : face)
            for (std::uint32_t v = 0; v < 8; ++v)
                if (twice.vertices[corner] == twice.vertices[v]) corner = v;
    EXPECT_EQ(check_part(twice).split_vertices, 1u);
    EXPECT_FALSE(check_part(twice).is_manifold());
    EXPECT_TRUE(check_part(twice).is_closed());
}

}  // namespace
}  // namespace exemplar
