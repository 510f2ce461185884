// Every damage does what it says, on a generated shape and on meshes of almost nothing.
#include "host/synth/damage/damage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>
#include <string>

#include "host/core/errors.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/topology.h"
#include "host/synth/shapes/shapes.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

constexpr std::uint64_t k_seed = 7;

const TriangleMesh& cup() {
    static const TriangleMesh mesh = make_shape("cup", 3, 2000).mesh;
    return mesh;
}
DamagedMesh damaged_cup(std::string_view name, std::uint64_t seed = k_seed) {
    return damage_named(name).apply(cup(), seed);
}

double total_area(const TriangleMesh& mesh) {
    const std::vector<float> areas = face_areas(mesh);
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}
float diagonal(const TriangleMesh& mesh) {
    Eigen::AlignedBox3f box;
    for (const Vec3& v : mesh.vertices) box.extend(v);
    return box.diagonal().norm();
}
std::array<Vec3, 3> corners(const TriangleMesh& mesh, std::size_t face) {
    const Face& f = mesh.faces[face];
    return {mesh.vertices[f[0]], mesh.vertices[f[1]], mesh.vertices[f[2]]};
}
std::array<Vec3, 3> turned(const std::array<Vec3, 3>& corner) {
    return {corner[0], corner[2], corner[1]};
}
Face sorted(Face face) {
    std::ranges::sort(face);
    return face;
}
std::size_t changed_faces(const DamagedMesh& damaged) {
    std::size_t count = 0;
    for (std::size_t f = 0; f < damaged.mesh.face_count(); ++f)
        count += corners(damaged.mesh, f) != corners(cup(), damaged.origin[f]);
    return count;
}
/// Per face of the original the area of the faces that came from it.
std::vector<double> areas_by_origin(const DamagedMesh& damaged) {
    const std::vector<float> area = face_areas(damaged.mesh);
    std::vector<double> sum(cup().face_count(), 0);
    for (std::size_t f = 0; f < area.size(); ++f) sum[damaged.origin[f]] += area[f];
    return sum;
}
void expect_closed_and_oriented(const TriangleMesh& mesh) {
    const MeshReport report = validate_mesh(mesh);
    EXPECT_EQ(report.boundary_edges, 0U);
    EXPECT_TRUE(report.non_manifold_edges.empty());
    EXPECT_TRUE(report.inconsistent_edges.empty());
    EXPECT_FALSE(report.inside_out);
}

TriangleMesh few_faces(std::size_t count) {
    TriangleMesh mesh = shapes::box(1, 2, 3, 1);
    mesh.faces.resize(count);
    mesh.source_face_count = static_cast<std::uint32_t>(count);
    return mesh;
}
std::vector<std::pair<std::string, TriangleMesh>> all_meshes() {
    TriangleMesh polygons = cup();
    polygons.source_face_count = static_cast<std::uint32_t>((cup().face_count() + 1) / 2);
    for (std::uint32_t f = 0; f < cup().face_count(); ++f) polygons.source_face.push_back(f / 2);
    TriangleMesh soup = damaged_cup("unwelded").mesh;
    TriangleMesh point = few_faces(3);
    for (Vec3& v : point.vertices) v = Vec3(1, 1, 1);
    TriangleMesh repeated = few_faces(12);
    repeated.faces.insert(repeated.faces.end(), {{0, 0, 1}, {2, 2, 2}, {0, 1, 0}});
    return {{"cup", cup()},
            {"polygons", polygons},
            {"soup", soup},
            {"one", few_faces(1)},
            {"two", few_faces(2)},
            {"five", few_faces(5)},
            {"box", few_faces(12)},
            {"point", point},
            {"repeated", repeated},
            {"fins", damaged_cup("fins").mesh},
            {"open", shapes::grid(9, 7, 1)}};
}

TEST(Damages, AreUsableAndKnowWhereTheirFacesCameFrom) {
    for (const auto& [name, mesh] : all_meshes())
        for (const Damage& damage : damages()) {
            SCOPED_TRACE(name + " " + std::string(damage.name));
            const DamagedMesh damaged = damage.apply(mesh, k_seed);
            ASSERT_FALSE(damaged.mesh.faces.empty());
            ASSERT_EQ(damaged.origin.size(), damaged.mesh.face_count());
            for (const std::uint32_t origin : damaged.origin) ASSERT_LT(origin, mesh.face_count());
            for (const Face& face : damaged.mesh.faces)
                for (const std::uint32_t v : face) ASSERT_LT(v, damaged.mesh.vertex_count());
            EXPECT_TRUE(validate_mesh(damaged.mesh).usable());
            const bool quads = damage.name == "quads";
            EXPECT_EQ(damaged.mesh.source_face.size(), quads ? damaged.mesh.face_count() : 0U);
            if (!quads) {
                EXPECT_EQ(damaged.mesh.source_face_count, damaged.mesh.face_count());
            }
        }
}

TEST(Damages, FollowTheirSeed) {
    const std::set<std::string_view> not_random{"inside-out", "unwelded",    "decimated", "refined-4x",
                                                "refined-9x", "scaled-down", "scaled-up"};
    for (const Damage& damage : damages()) {
        SCOPED_TRACE(damage.name);
        const DamagedMesh a = damage.apply(cup(), 1), b = damage.apply(cup(), 1), c = damage.apply(cup(), 2);
        EXPECT_EQ(a.mesh.vertices, b.mesh.vertices);
        EXPECT_EQ(a.mesh.faces, b.mesh.faces);
        EXPECT_EQ(a.origin, b.origin);
        EXPECT_EQ(a.mesh.vertices == c.mesh.vertices && a.mesh.faces == c.mesh.faces, not_random.contains(damage.name));
    }
}

TEST(Damages, HaveNamesOfTheirOwn) {
    std::set<std::string_view> names;
    for (const Damage& damage : damages()) {
        EXPECT_TRUE(names.insert(damage.name).second) << damage.name;
        EXPECT_EQ(&damage_named(damage.name), &damage);
    }
    try {
        damage_named("hole");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'holes'?"));
    }
}

TEST(Holes, AreFewAndTakeAFiftiethOfTheFaces) {
    const DamagedMesh damaged = damaged_cup("holes");
    const std::size_t removed = cup().face_count() - damaged.mesh.face_count();
    EXPECT_LE(removed, cup().face_count() / 50 + 4);
    EXPECT_GE(removed, cup().face_count() / 100) << "patches may overlap, but hardly all of them";
    EXPECT_EQ(changed_faces(damaged), 0U);
    TriangleMesh missing = cup();
    missing.faces.clear();
    const std::set<std::uint32_t> kept(damaged.origin.begin(), damaged.origin.end());
    EXPECT_EQ(kept.size(), damaged.origin.size());
    for (std::uint32_t f = 0; f < cup().face_count(); ++f)
        if (!kept.contains(f)) missing.faces.push_back(cup().faces[f]);
    EXPECT_LE(validate_mesh(missing).components, 4U);
}

TEST(DuplicatedFaces, AreATwentiethTwice) {
    const DamagedMesh damaged = damaged_cup("duplicated-faces");
    const std::size_t added = damaged.mesh.face_count() - cup().face_count();
    EXPECT_NEAR(static_cast<double>(added), 0.05 * static_cast<double>(cup().face_count()), 1);
    EXPECT_EQ(validate_mesh(damaged.mesh).duplicate_faces.size(), added) << "no face three times";
    EXPECT_EQ(changed_faces(damaged), 0U);
}

TEST(FlippedFaces, AreATenthTurnedAround) {
    const DamagedMesh damaged = damaged_cup("flipped-faces");
    const std::size_t flipped = changed_faces(damaged);
    EXPECT_NEAR(static_cast<double>(flipped), 0.10 * static_cast<double>(cup().face_count()), 1);
    for (std::size_t f = 0; f < damaged.mesh.face_count(); ++f) {
        const auto now = corners(damaged.mesh, f), before = corners(cup(), damaged.origin[f]);
        EXPECT_TRUE(now == before || now == turned(before)) << f;
    }
}

TEST(InsideOut, TurnsAllFaces) {
    const DamagedMesh damaged = damaged_cup("inside-out");
    EXPECT_TRUE(validate_mesh(damaged.mesh).inside_out);
    EXPECT_EQ(changed_faces(damaged), cup().face_count());
}

TEST(SplitParts, FallApartAndLookTheSame) {
    const DamagedMesh damaged = damaged_cup("split-parts");
    EXPECT_EQ(damaged.mesh.face_count(), cup().face_count());
    EXPECT_EQ(changed_faces(damaged), 0U) << "nothing moves";
    const MeshReport report = validate_mesh(damaged.mesh);
    EXPECT_GT(report.components, 1U);
    EXPECT_LT(report.components, 30U);
    EXPECT_TRUE(report.unreferenced_vertices.empty());
    EXPECT_TRUE(report.inconsistent_edges.empty());
}

TEST(Unwelded, EveryFaceIsByItself) {
    const DamagedMesh damaged = damaged_cup("unwelded");
    EXPECT_EQ(damaged.mesh.vertex_count(), 3 * cup().face_count());
    EXPECT_EQ(changed_faces(damaged), 0U);
    EXPECT_EQ(validate_mesh(damaged.mesh).components, cup().face_count());
}

TEST(Fins, StickOutOfEdgesOfTwoOtherFaces) {
    const DamagedMesh damaged = damaged_cup("fins");
    const std::size_t added = damaged.mesh.face_count() - cup().face_count();
    EXPECT_NEAR(static_cast<double>(added), 0.01 * static_cast<double>(cup().face_count()), 1);
    EXPECT_EQ(validate_mesh(damaged.mesh).non_manifold_edges.size(), added);
    const std::vector<Vec3> normals = face_normals(damaged.mesh);
    for (std::size_t f = cup().face_count(); f < damaged.mesh.face_count(); ++f)
        EXPECT_NEAR(normals[f].dot(normals[damaged.origin[f]]), 0, 1e-3) << "upright on its face";
}

TEST(Slivers, KeepTheSurface) {
    const DamagedMesh damaged = damaged_cup("slivers");
    expect_closed_and_oriented(damaged.mesh);
    const std::size_t added = damaged.mesh.face_count() - cup().face_count();
    EXPECT_GT(added, cup().face_count() / 10) << "two for most of the 75 edges per 1000 faces";
    const std::vector<double> area = areas_by_origin(damaged);
    const std::vector<float> before = face_areas(cup());
    for (std::size_t f = 0; f < before.size(); ++f) EXPECT_NEAR(area[f], before[f], 1e-4F * before[f]) << f;
    const std::vector<float> now = face_areas(damaged.mesh);
    std::size_t thin = 0;
    for (std::size_t f = 0; f < now.size(); ++f) thin += now[f] < 0.01F * before[damaged.origin[f]];
    EXPECT_EQ(thin, added);
}

TEST(Noise, MovesVerticesByAShareOfTheirEdges) {
    double previous = 0;
    for (const auto& [name, least, most] : {std::tuple{"noise", 0.04, 0.12}, std::tuple{"strong-noise", 0.1, 0.3}}) {
        SCOPED_TRACE(name);
        const DamagedMesh damaged = damaged_cup(name);
        EXPECT_EQ(damaged.mesh.faces, cup().faces);
        double squared = 0;
        for (std::size_t v = 0; v < cup().vertex_count(); ++v)
            squared += (damaged.mesh.vertices[v] - cup().vertices[v]).squaredNorm();
        const double moved = std::sqrt(squared / static_cast<double>(cup().vertex_count()));
        const double edge = std::sqrt(total_area(cup()) / static_cast<double>(cup().face_count()) * 4 / std::sqrt(3.0));
        EXPECT_GT(moved, least * edge);
        EXPECT_LT(moved, most * edge);
        EXPECT_LE(moved, 0.0101 * diagonal(cup()));
        EXPECT_GT(moved, previous);
        previous = moved;
    }
}

TEST(Decimated, HasATenthOfTheFacesWhereTheOldOnesWere) {
    const DamagedMesh damaged = damaged_cup("decimated");
    EXPECT_NEAR(static_cast<double>(damaged.mesh.face_count()) / static_cast<double>(cup().face_count()), 0.1, 0.03);
    const std::vector<Vec3> now = face_centers(damaged.mesh), before = face_centers(cup());
    const std::vector<Vec3> facing = face_normals(damaged.mesh), faced = face_normals(cup());
    const double edge = std::sqrt(total_area(damaged.mesh) / static_cast<double>(now.size()) * 4 / std::sqrt(3.0));
    std::size_t far = 0, away = 0;
    for (std::size_t f = 0; f < now.size(); ++f) {
        far += (now[f] - before[damaged.origin[f]]).norm() > edge;
        away += facing[f].dot(faced[damaged.origin[f]]) < 0;
    }
    EXPECT_LT(far, now.size() / 20) << "at most the width of a face away";
    EXPECT_LT(away, now.size() / 50);
    EXPECT_NEAR(total_area(damaged.mesh) / total_area(cup()), 1, 0.1);
}

TEST(Refined, CutsFacesIntoEqualOnes) {
    for (const auto& [name, parts] : {std::pair{"refined-4x", 4U}, std::pair{"refined-9x", 9U}}) {
        SCOPED_TRACE(name);
        const DamagedMesh damaged = damaged_cup(name);
        ASSERT_EQ(damaged.mesh.face_count(), parts * cup().face_count());
        EXPECT_EQ(damaged.mesh.vertex_count(),
                  damaged.mesh.face_count() / 2 + cup().vertex_count() - cup().face_count() / 2)
            << "one vertex for both sides of an edge";
        expect_closed_and_oriented(damaged.mesh);
        const std::vector<float> now = face_areas(damaged.mesh), before = face_areas(cup());
        const std::vector<Vec3> facing = face_normals(damaged.mesh), faced = face_normals(cup());
        for (std::size_t f = 0; f < now.size(); ++f) {
            const std::uint32_t origin = damaged.origin[f];
            ASSERT_NEAR(now[f] * static_cast<float>(parts), before[origin], 1e-2F * before[origin]) << f;
            ASSERT_GT(facing[f].dot(faced[origin]), 0.999F) << f;
        }
    }
}

TEST(Rotated, TurnsWithoutStretching) {
    const DamagedMesh damaged = damaged_cup("rotated");
    expect_closed_and_oriented(damaged.mesh);
    const auto& before = cup().vertices;
    const auto& now = damaged.mesh.vertices;
    for (std::size_t v = 1; v < now.size(); ++v)
        EXPECT_NEAR((now[v] - now[0]).norm(), (before[v] - before[0]).norm(), 1e-5F);
    EXPECT_GT((now[0] - before[0]).norm(), 0.01F);
}

TEST(Scaled, IsSmallerAndLarger) {
    const double area = total_area(cup());
    EXPECT_NEAR(total_area(damaged_cup("scaled-down").mesh) * 1e12 / area, 1, 1e-4);
    EXPECT_NEAR(total_area(damaged_cup("scaled-up").mesh) * 1e-12 / area, 1, 1e-4);
}

TEST(FarAway, IsAHundredDiagonalsOff) {
    const DamagedMesh damaged = damaged_cup("far-away");
    const Vec3 moved = area_centroid(damaged.mesh) - area_centroid(cup());
    EXPECT_NEAR(moved.norm() / diagonal(cup()), 100, 0.01);
    EXPECT_NEAR(diagonal(damaged.mesh), diagonal(cup()), 1e-4F * diagonal(cup()));
}

TEST(Quads, AreNeighborsInPairs) {
    const DamagedMesh damaged = damaged_cup("quads");
    const TriangleMesh& mesh = damaged.mesh;
    expect_closed_and_oriented(mesh);
    EXPECT_LT(mesh.source_face_count, 0.7 * static_cast<double>(mesh.face_count())) << "most are paired";
    EXPECT_GE(2 * mesh.source_face_count, mesh.face_count());
    for (std::uint32_t f = 0, previous = 0; f < mesh.face_count(); previous = mesh.source_of(f++)) {
        EXPECT_GE(mesh.source_of(f), previous) << "in the order of a file";
        if (f == 0 || mesh.source_of(f) != previous) continue;
        const Face &a = mesh.faces[f - 1], &b = mesh.faces[f];
        EXPECT_TRUE(a[0] == b[2] && a[2] == b[0]) << "a fan around the first corner, or the third";
    }
    EXPECT_EQ(mesh.source_of(static_cast<std::uint32_t>(mesh.face_count() - 1)) + 1, mesh.source_face_count);
    std::size_t recut = 0;
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        recut += sorted(mesh.faces[f]) != sorted(cup().faces[damaged.origin[f]]);
    EXPECT_GT(recut, mesh.face_count() / 5);
    EXPECT_LT(recut, mesh.face_count() * 3 / 5);
    EXPECT_NEAR(total_area(mesh) / total_area(cup()), 1, 0.01);
}

TEST(LooseVertices, BelongToNoFace) {
    const DamagedMesh damaged = damaged_cup("loose-vertices");
    EXPECT_EQ(validate_mesh(damaged.mesh).unreferenced_vertices.size(), 100U);
    EXPECT_EQ(changed_faces(damaged), 0U);
    EXPECT_GT(diagonal(damaged.mesh), 3 * diagonal(cup()));
}

TEST(Shuffled, IsTheSameInAnotherOrder) {
    const DamagedMesh damaged = damaged_cup("shuffled");
    expect_closed_and_oriented(damaged.mesh);
    EXPECT_EQ(std::set<std::uint32_t>(damaged.origin.begin(), damaged.origin.end()).size(), cup().face_count());
    const std::vector<Vec3> now = face_normals(damaged.mesh), before = face_normals(cup());
    std::size_t same_start = 0;
    for (std::size_t f = 0; f < now.size(); ++f) {
        auto corner = corners(damaged.mesh, f);
        const auto original = corners(cup(), damaged.origin[f]);
        same_start += corner == original;
        for (int k = 0; k < 2 && corner != original; ++k) std::rotate(corner.begin(), corner.begin() + 1, corner.end());
        EXPECT_EQ(corner, original) << "the same corners, turned the same way";
    }
    EXPECT_LT(same_start, now.size() / 2);
    EXPECT_NE(damaged.mesh.vertices, cup().vertices);
}

}  // namespace
}  // namespace exemplar
