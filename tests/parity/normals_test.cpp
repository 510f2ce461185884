#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/vertex_rings.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "tests/gpu/support/environment.h"
#include "tests/parity/surfaces.h"

// The device works in single precision: each face's share is off by some ten roundings, 6e-7 of its size, and the
// shares around a vertex of these meshes add up to at least a tenth of their sizes.
namespace exemplar {
namespace {

using shared::vec4;
using test_support::download;
using test_support::shared_device;
using test_support::strip;
using test_support::waved;

constexpr float k_normals_tolerance = 6e-6f;

std::vector<vec4> device_normals(const TriangleMesh& mesh) {
    const GpuSurface surface(shared_device(), mesh);
    const Buffer vertices = test_support::upload_vertices(shared_device(), mesh.vertices);
    GpuNormals normals(surface);
    Stream stream(shared_device());
    normals.record(stream, vertices);
    stream.finish();
    return download(normals.normals());
}

void expect_normals_parity(const TriangleMesh& mesh) {
    const std::vector<vec4> actual = device_normals(mesh);
    const std::vector<Vec3> expected = vertex_normals(mesh);
    ASSERT_EQ(actual.size(), expected.size());
    for (std::size_t v = 0; v < expected.size(); ++v)
        ASSERT_LE((test_support::xyz(actual[v]) - expected[v]).norm(), k_normals_tolerance)
            << "vertex " << v << ": " << test_support::xyz(actual[v]).transpose() << " instead of "
            << expected[v].transpose();
}

// The faces that the rings of a mesh describe, turned so that each begins with the smallest vertex, in order.
std::vector<Face> faces_of_rings(const VertexRings& rings) {
    std::vector<Face> faces;
    for (std::uint32_t v = 0; v < rings.begin.size(); ++v) {
        std::uint32_t last = k_invalid_index;
        for (std::size_t i = 0;; ++i) {
            const std::uint32_t entry = (&rings.texels[rings.begin[v] + i / 4].x)[i % 4];
            const std::uint32_t corner = entry & shared::k_ring_vertex;
            if (!(entry & shared::k_ring_fan)) faces.push_back({v, last, corner});
            last = corner;
            if (entry & shared::k_ring_last) break;
        }
    }
    for (Face& face : faces) std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    std::sort(faces.begin(), faces.end());
    return faces;
}

// Each face once per corner.
std::vector<Face> thrice(const std::vector<Face>& proper) {
    std::vector<Face> faces;
    for (Face face : proper) {
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        faces.insert(faces.end(), 3, face);
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

std::size_t entry_count(const VertexRings& rings) {
    std::size_t count = 0;
    for (std::size_t v = 0; v < rings.begin.size(); ++v)
        for (std::size_t i = 0;; ++i) {
            ++count;
            if ((&rings.texels[rings.begin[v] + i / 4].x)[i % 4] & shared::k_ring_last) break;
        }
    return count;
}

/// Random faces over few vertices: edges of many faces, clashing orientations, doubled faces, isolated vertices.
TriangleMesh tangle(std::size_t vertices, std::size_t faces, std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh;
    for (std::size_t v = 0; v < vertices; ++v) mesh.vertices.push_back(test_support::random_vec3(random));
    const auto vertex = [&] { return static_cast<std::uint32_t>(random.index(vertices)); };
    while (mesh.faces.size() < faces) {
        const Face face{vertex(), vertex(), vertex()};
        if (face[0] != face[1] && face[1] != face[2] && face[2] != face[0]) mesh.faces.push_back(face);
    }
    return shapes::detail::finished(std::move(mesh));
}

TEST(VertexRings, HoldEveryFaceOnceAtEachOfItsCorners) {
    for (const TriangleMesh& mesh : {shapes::icosphere(2, 1), shapes::grid(5, 4, 1), strip(9), tangle(12, 60, 1),
                                     tangle(5, 200, 2), tangle(100, 20, 3), TriangleMesh{}})
        EXPECT_EQ(faces_of_rings(build_vertex_rings(mesh)), thrice(mesh.faces));
}

TEST(VertexRings, AreOneFanAroundManifoldVertices) {
    const TriangleMesh sphere = shapes::icosphere(2, 1), grid = shapes::grid(5, 4, 1);
    // A closed ring names its first corner twice, an open fan has a corner more than faces.
    EXPECT_EQ(entry_count(build_vertex_rings(sphere)), 3 * sphere.face_count() + sphere.vertex_count());
    EXPECT_EQ(entry_count(build_vertex_rings(grid)), 3 * grid.face_count() + grid.vertex_count());
}

TEST(VertexRings, RefuseFacesOfVerticesThatAreNotThere) {
    TriangleMesh mesh = shapes::grid(2, 2, 1);
    mesh.faces[3][1] = 9;
    EXPECT_THROW(build_vertex_rings(mesh), MeshError);
}

TEST(GpuSurface, HoldsItsFaces) {
    const TriangleMesh mesh = shapes::icosphere(1, 1);
    const GpuSurface surface(shared_device(), mesh);
    std::vector<shared::uvec4> faces(surface.face_count());
    surface.faces().download(std::span(faces));
    ASSERT_EQ(faces.size(), mesh.face_count());
    for (std::size_t f = 0; f < faces.size(); ++f) EXPECT_EQ((Face{faces[f].x, faces[f].y, faces[f].z}), mesh.faces[f]);
}

TEST(GpuSurface, RefusesMeshesOverTheLimitOfTexels) {
    const std::size_t limit = shared_device().info().max_texels;
    if (limit > 1'000'000) GTEST_SKIP() << "the device sees " << limit << " texels at once";
    TriangleMesh mesh;
    mesh.vertices.resize(limit + 1, Vec3::Zero());
    EXPECT_THROW(GpuSurface(shared_device(), mesh), DeviceLimitError);
}

TEST(NormalParity, OddNumbersOfVerticesAndFaces) {
    for (const std::size_t vertices : {0u, 1u, 2u, 3u, 63u, 64u, 65u, 66u, 67u, 257u}) {
        SCOPED_TRACE(vertices);
        expect_normals_parity(strip(vertices));
    }
}

// A fan of `faces` faces around the first vertex.
TriangleMesh fan(std::uint32_t faces) {
    TriangleMesh mesh;
    mesh.vertices.push_back({0, 0, 1});
    for (std::uint32_t i = 0; i <= faces; ++i) {
        const double angle = 3.0 * i / faces;
        mesh.vertices.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
        if (i > 0) mesh.faces.push_back({0, i, i + 1});
    }
    return mesh;
}

// Sums of so many shares are off by a rounding each, at most. More faces than a kernel can go around are refused.
TEST(NormalParity, AVertexOfManyFaces) {
    constexpr std::uint32_t k_faces = 30'000;
    const TriangleMesh most = fan(k_faces);
    const Vec3 normal = test_support::xyz(device_normals(most)[0]), expected = vertex_normals(most)[0];
    EXPECT_LE((normal - expected).norm(), k_faces * std::numeric_limits<float>::epsilon() / 2);
    EXPECT_THROW(GpuSurface(shared_device(), fan(40'000)), DeviceLimitError);
}

TEST(NormalParity, ClosedAndBoundedSurfaces) {
    expect_normals_parity(waved(shapes::icosphere(3, 1), 0.2f));
    expect_normals_parity(waved(shapes::torus(2, 0.7f, 40, 17), 0.1f));
    expect_normals_parity(waved(shapes::grid(13, 9, 2), 0.3f));
    expect_normals_parity(waved(shapes::cylinder(1, 3, 19, 7, false), 0.2f));
    expect_normals_parity(shapes::box(1, 2, 3, 4));
}

TEST(NormalParity, TangledFaces) {
    // Random shares nearly cancel at some vertices: compare where they do not.
    const TriangleMesh mesh = tangle(300, 500, 4);
    const std::vector<vec4> actual = device_normals(mesh);
    const std::vector<Vec3> expected = vertex_normals(mesh);
    for (std::size_t v = 0; v < expected.size(); ++v)
        ASSERT_LE((test_support::xyz(actual[v]) - expected[v]).norm(), 1e-3f) << "vertex " << v;
}

TEST(NormalParity, DegenerateFacesAndLooseVertices) {
    TriangleMesh mesh = waved(shapes::icosphere(2, 1), 0.2f);
    const auto first = static_cast<std::uint32_t>(mesh.vertex_count());
    mesh.vertices.push_back({9, 9, 9});                                     // nobody's
    for (float x : {0.0f, 1.0f, 2.0f}) mesh.vertices.push_back({x, 5, 5});  // on a line
    mesh.vertices.push_back(mesh.vertices[0]);                              // where another is
    mesh.faces.push_back({first + 1, first + 2, first + 3});
    mesh.faces.push_back({3, 3, 8});
    mesh.faces.push_back({7, 7, 7});
    mesh.faces.push_back({0, first + 4, 1});
    expect_normals_parity(mesh);
    const std::vector<vec4> normals = device_normals(mesh);
    for (const std::uint32_t v : {first, first + 1, first + 2}) {
        EXPECT_EQ(test_support::xyz(normals[v]), Vec3::UnitZ());
        EXPECT_EQ(normals[v].w, 0.0f);
    }
}

TEST(NormalParity, NeedlesAndCaps) {
    // Stretched a hundredfold, faces lose two digits of their height at most.
    TriangleMesh mesh = waved(shapes::torus(2, 0.7f, 30, 20), 0.1f);
    for (Vec3& p : mesh.vertices) p.x() *= 100.0f;
    expect_normals_parity(mesh);
}

TEST(NormalParity, AreasAddUpToThoseOfTheFaces) {
    for (const TriangleMesh& mesh : {waved(shapes::torus(2, 0.7f, 30, 20), 0.1f), shapes::box(1, 2, 3, 4), strip(65),
                                     shapes::scaled(shapes::icosphere(2, 1), 1000.0f)}) {
        double around_vertices = 0, of_faces = 0;
        for (const vec4& normal : device_normals(mesh)) around_vertices += static_cast<double>(normal.w);
        for (const float area : face_areas(mesh)) of_faces += static_cast<double>(area);
        EXPECT_NEAR(around_vertices, of_faces, 1e-6 * of_faces);
    }
}

// Fourth powers of lengths would leave the range of single precision.
TEST(NormalParity, MeshesOfAnyScale) {
    const TriangleMesh mesh = waved(shapes::icosphere(2, 1), 0.2f);
    for (const float scale : {1e-15f, 1e-6f, 1e6f, 1e15f}) {
        SCOPED_TRACE(scale);
        expect_normals_parity(shapes::scaled(mesh, scale));
    }
}

TEST(NormalParity, RefusesVerticesOfAnotherSurface) {
    const GpuSurface surface(shared_device(), shapes::icosphere(1, 1));
    GpuNormals normals(surface);
    Stream stream(shared_device());
    EXPECT_THROW(normals.record(stream, test_support::upload_vertices(shared_device(), std::vector<Vec3>(41))),
                 UsageError);
    EXPECT_THROW(normals.record(stream, Buffer()), UsageError);
}

TEST(NormalParity, IsDeterministic) {
    const TriangleMesh mesh = waved(shapes::icosphere(3, 1), 0.2f);
    const std::vector<vec4> first = device_normals(mesh), second = device_normals(mesh);
    EXPECT_EQ(std::memcmp(first.data(), second.data(), first.size() * sizeof(vec4)), 0);
}

}  // namespace
}  // namespace exemplar
