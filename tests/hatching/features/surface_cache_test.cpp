// Measured surfaces that are remembered on disk.

#include "host/hatching/features/surface_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "host/core/random.h"
#include "host/data/safetensors.h"
#include "tests/support/mesh_files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// A torus with dents, and a ball that no path on the surface leads to; fewer than 1000 faces, a number that three
/// does not divide.
TriangleMesh random_mesh(std::uint64_t seed) {
    Random random(seed);
    TriangleMesh mesh = shapes::torus(2, 0.7F, 11, 7);
    for (Vec3& vertex : mesh.vertices) vertex *= static_cast<float>(random.uniform(0.9, 1.1));
    mesh = shapes::joined(mesh, shapes::translated(shapes::icosphere(1, 0.5F), Vec3(4, 0, 0)));
    mesh.faces.pop_back();
    mesh.source_face.resize(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) mesh.source_face[f] = f / 2;
    mesh.source_face_count = (static_cast<std::uint32_t>(mesh.face_count()) + 1) / 2;
    return mesh;
}

TriangleMesh turned_inside_out(TriangleMesh mesh) {
    for (Face& face : mesh.faces) std::swap(face[1], face[2]);
    return mesh;
}

template <typename T>
void expect_same(const char* what, const std::vector<T>& a, const std::vector<T>& b) {
    ASSERT_EQ(a.size(), b.size()) << what;
    EXPECT_FALSE(a.empty()) << what;
    EXPECT_TRUE(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0) << what;
}

void expect_same(const VertexCurvature& a, const VertexCurvature& b) {
    expect_same("k1", a.k1, b.k1);
    expect_same("k2", a.k2, b.k2);
    expect_same("e1", a.e1, b.e1);
    expect_same("e2", a.e2, b.e2);
    expect_same("derivative", a.derivative, b.derivative);
}

/// Bit by bit, but for the times.
void expect_same(const HatchingSurface& a, const HatchingSurface& b) {
    expect_same("vertices", a.mesh.vertices, b.mesh.vertices);
    expect_same("faces", a.mesh.faces, b.mesh.faces);
    EXPECT_EQ(a.mesh.source_face, b.mesh.source_face);
    EXPECT_EQ(a.mesh.source_face_count, b.mesh.source_face_count);
    expect_same("normals", a.normals, b.normals);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(a.feature_size, b.feature_size);
    for (std::size_t s = 0; s < a.curvature.size(); ++s) expect_same(a.curvature[s], b.curvature[s]);
    expect_same(a.line_curvature, b.line_curvature);
    expect_same("neighbors", a.neighbors, b.neighbors);
    EXPECT_EQ(a.descriptors.rows, b.descriptors.rows);
    EXPECT_EQ(a.descriptors.names, b.descriptors.names);
    expect_same("descriptors", a.descriptors.values, b.descriptors.values);
    expect_same("ambient", a.occlusion.ambient, b.occlusion.ambient);
    expect_same("visibility", a.occlusion.visibility, b.occlusion.visibility);
    expect_same("transfer", a.occlusion.transfer, b.occlusion.transfer);
    for (std::size_t s = 0; s < a.directions.k_max.size(); ++s) {
        expect_same("k_max", a.directions.k_max[s], b.directions.k_max[s]);
        expect_same("k_min", a.directions.k_min[s], b.directions.k_min[s]);
        expect_same("e_a", a.directions.e_a[s], b.directions.e_a[s]);
        expect_same("e_b", a.directions.e_b[s], b.directions.e_b[s]);
    }
    expect_same("ridges", a.directions.ridges, b.directions.ridges);
    expect_same("valleys", a.directions.valleys, b.directions.valleys);
    expect_same("sample_face", a.sample_face, b.sample_face);
    expect_same("sample_bin", a.sample_bin, b.sample_bin);
    expect_same("face_sample", a.face_sample, b.face_sample);
}

class SurfaceCache : public testing::Test {
  protected:
    HatchingSurface surface(const TriangleMesh& mesh) const { return cached_surface(mesh, folder_ / "cache"); }
    std::vector<fs::path> entries() const {
        std::vector<fs::path> paths;
        for (const auto& entry : fs::directory_iterator(folder_ / "cache")) paths.push_back(entry.path());
        return paths;
    }
    /// Replaces the only entry by `bytes`; the surface must come out right, and the entry must be whole again.
    void expect_measured_anew(const std::string& bytes) {
        const fs::path entry = entries().front();
        mesh_files::write_bytes(entry, bytes);
        expect_same(surface(mesh_), truth_);
        EXPECT_NE(read_file(entry), bytes);
        expect_same(surface(mesh_), truth_);
        EXPECT_EQ(entries().size(), 1U);
    }

    mesh_files::TemporaryFolder folder_;
    TriangleMesh mesh_ = random_mesh(1);
    HatchingSurface truth_ = measure_surface(mesh_);
};

TEST_F(SurfaceCache, ReturnsWhatWasMeasured) {
    ASSERT_NE(std::ranges::count(truth_.sample_bin, k_context_ranges), 0);
    ASSERT_NE(std::ranges::count(truth_.sample_bin, 0), 0);
    ASSERT_NE(truth_.sample_bin.size() % 3, 0U);
    const HatchingSurface first = surface(mesh_), second = surface(mesh_);
    expect_same(first, truth_);
    expect_same(second, truth_);
    EXPECT_EQ(first.seconds, second.seconds);  // the times of the first call: nothing was measured again
    EXPECT_EQ(entries().size(), 1U);
}

TEST_F(SurfaceCache, TellsMeshesApart) {
    const HatchingSurface of_one = surface(mesh_);
    TriangleMesh other = mesh_;
    other.vertices[3].x() += 0.01F;
    expect_same(surface(other), measure_surface(other));
    EXPECT_EQ(entries().size(), 2U);
    // What polygons a mesh was cut from is no part of what is measured: it comes from the mesh that is asked for.
    TriangleMesh of_triangles = mesh_;
    of_triangles.source_face.clear();
    of_triangles.source_face_count = static_cast<std::uint32_t>(mesh_.face_count());
    expect_same(surface(of_triangles), measure_surface(of_triangles));
    EXPECT_EQ(entries().size(), 2U);
}

TEST_F(SurfaceCache, RemembersThatMeshesWereTurnedOutward) {
    const TriangleMesh ball = shapes::icosphere(1, 1), inside_out = turned_inside_out(ball);
    const HatchingSurface measured = measure_surface(inside_out);
    ASSERT_EQ(measured.mesh.faces, turned_inside_out(inside_out).faces);
    surface(ball);
    expect_same(surface(inside_out), measured);
    expect_same(surface(inside_out), measured);
    EXPECT_EQ(entries().size(), 2U);
}

TEST_F(SurfaceCache, SurfacesThatWereLoadedMove) {
    surface(mesh_);
    HatchingSurface loaded = surface(mesh_), measured = truth_;
    std::vector<Vec3> moved = mesh_.vertices;
    for (Vec3& vertex : moved) vertex.z() += 0.2F * vertex.x() * vertex.x();
    move_surface(loaded, moved);
    move_surface(measured, moved);
    expect_same(loaded, measured);
}

TEST_F(SurfaceCache, DamagedEntriesAreMeasuredAnew) {
    surface(mesh_);
    const std::string whole = read_file(entries().front());
    expect_measured_anew("");
    expect_measured_anew("not a safetensors file");
    for (const std::size_t kept : {std::size_t{7}, whole.size() / 2, whole.size() - 1})
        expect_measured_anew(whole.substr(0, kept));
    for (const std::size_t place : {std::size_t{40}, whole.size() / 3, whole.size() - 2}) {
        std::string flipped = whole;
        flipped[place] = static_cast<char>(flipped[place] ^ 0x10);
        expect_measured_anew(flipped);
    }
}

TEST_F(SurfaceCache, EntriesOfOtherVersionsOrMeshesAreMeasuredAnew) {
    surface(mesh_);
    const fs::path entry = entries().front(), changed = folder_ / "changed.safetensors";
    TensorFile file = read_safetensors(entry);
    file.metadata["version"] = std::to_string(k_surface_version + 1);
    write_safetensors(changed, file);
    expect_measured_anew(read_file(changed));
    cached_surface(shapes::icosphere(1, 1), folder_ / "other");
    expect_measured_anew(read_file(fs::directory_iterator(folder_ / "other")->path()));
}

TEST_F(SurfaceCache, AFolderThatCannotBeWrittenIsNoObstacle) {
    mesh_files::write_bytes(folder_ / "file", "in the way");
    expect_same(cached_surface(mesh_, folder_ / "file"), truth_);
    expect_same(cached_surface(mesh_, {}), truth_);
    EXPECT_THROW(cached_surface({}, folder_ / "cache"), MeshError);
}

}  // namespace
}  // namespace exemplar
