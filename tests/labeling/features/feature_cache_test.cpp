#include "host/labeling/features/feature_cache.h"

#include <filesystem>
#include <string>

#include "host/data/result_cache.h"
#include "host/data/safetensors.h"
#include "tests/labeling/features/features_support.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using namespace feature_tests;
namespace fs = std::filesystem;

TriangleMesh small_mesh() {
    return lopsided_torus(12, 8);
}
FeatureOptions small_options() {
    FeatureOptions options;
    options.samples = 40;
    return options;
}

/// Every value, but not the times.
void expect_equal(const MeshFeatures& a, const MeshFeatures& b) {
    EXPECT_EQ(a.unary.names, b.unary.names);
    EXPECT_EQ(a.unary.values, b.unary.values);
    EXPECT_EQ(a.pairwise.names, b.pairwise.names);
    EXPECT_EQ(a.pairwise.values, b.pairwise.values);
    EXPECT_EQ(a.pairwise.rows, b.pairwise.rows);
    EXPECT_EQ(a.context.faces, b.context.faces);
    EXPECT_EQ(a.context.sample_face, b.context.sample_face);
    EXPECT_EQ(a.context.sample_area, b.context.sample_area);
    EXPECT_EQ(a.context.geodesic_bin, b.context.geodesic_bin);
    EXPECT_EQ(a.context.axis_position, b.context.axis_position);
    EXPECT_EQ(a.context.axis_edges, b.context.axis_edges);
    EXPECT_EQ(a.edge_context.begin, b.edge_context.begin);
    EXPECT_EQ(a.edge_context.edge, b.edge_context.edge);
    EXPECT_EQ(a.edge_context.bin, b.edge_context.bin);
    EXPECT_EQ(a.face_area, b.face_area);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.edges, b.edges);
    EXPECT_EQ(a.edge_length, b.edge_length);
    EXPECT_EQ(a.dihedral, b.dihedral);
}

class FeatureCache : public testing::Test {
  protected:
    MeshFeatures features() const { return cached_features(mesh_, small_options(), folder_ / "cache"); }
    std::vector<fs::path> entries() const {
        std::vector<fs::path> paths;
        for (const auto& entry : fs::directory_iterator(folder_ / "cache")) paths.push_back(entry.path());
        return paths;
    }
    /// Replaces the only entry by `bytes`; the features must come out right, and the entry must be whole again.
    void expect_recomputed(const std::string& bytes) {
        const fs::path entry = entries().front();
        mesh_files::write_bytes(entry, bytes);
        expect_equal(features(), truth_);
        EXPECT_NE(read_file(entry), bytes);
        expect_equal(features(), truth_);
        EXPECT_EQ(entries().size(), 1U);
    }

    mesh_files::TemporaryFolder folder_;
    TriangleMesh mesh_ = small_mesh();
    MeshFeatures truth_ = compute_features(mesh_, small_options());
};

TEST_F(FeatureCache, ReturnsWhatWasComputed) {
    const MeshFeatures first = features(), second = features();
    expect_equal(first, truth_);
    expect_equal(second, truth_);
    EXPECT_EQ(first.seconds, second.seconds);  // the times of the first call: nothing was computed again
    EXPECT_EQ(entries().size(), 1U);
}

TEST_F(FeatureCache, TellsMeshesAndOptionsApart) {
    features();
    TriangleMesh other = mesh_;
    other.vertices[0].x() += 0.01F;
    cached_features(other, small_options(), folder_ / "cache");
    FeatureOptions options = small_options();
    options.samples = 41;
    cached_features(mesh_, options, folder_ / "cache");
    options.orientation = true;
    EXPECT_EQ(cached_features(mesh_, options, folder_ / "cache").unary.cols(), 681U);
    EXPECT_EQ(entries().size(), 4U);
    EXPECT_NE(content_hash(other), content_hash(mesh_));
}

TEST_F(FeatureCache, DamagedEntriesAreComputedAgain) {
    features();
    const std::string whole = read_file(entries().front());
    expect_recomputed("");
    expect_recomputed("not a safetensors file");
    expect_recomputed(std::string(64, '\xff'));
    for (const std::size_t kept : {std::size_t{7}, std::size_t{100}, whole.size() / 2, whole.size() - 1})
        expect_recomputed(whole.substr(0, kept));
    expect_recomputed(whole + "more");
    for (const std::size_t place : {std::size_t{3}, std::size_t{40}, whole.size() / 3, whole.size() - 2}) {
        std::string flipped = whole;
        flipped[place] = static_cast<char>(flipped[place] ^ 0x10);
        expect_recomputed(flipped);
    }
}

TEST_F(FeatureCache, EntriesOfOtherVersionsOrShapesAreComputedAgain) {
    features();
    const fs::path entry = entries().front(), changed = folder_ / "changed.safetensors";
    TensorFile file = read_safetensors(entry);
    file.metadata["version"] = std::to_string(k_feature_version + 1);
    write_safetensors(changed, file);
    expect_recomputed(read_file(changed));
    file = read_safetensors(entry);
    file.metadata["unary"] = "[\"one name\"]";
    write_safetensors(changed, file);
    expect_recomputed(read_file(changed));
    file = read_safetensors(entry);
    file.metadata.erase("checksum");
    write_safetensors(changed, file);
    expect_recomputed(read_file(changed));
}

TEST_F(FeatureCache, AnEntryUnderAnOlderVersionsNameIsLeftAlone) {
    features();
    const fs::path entry = entries().front();
    std::string name = entry.filename().string();
    const std::string version = "-v" + std::to_string(k_feature_version) + "-";
    ASSERT_NE(name.find(version), std::string::npos);
    name.replace(name.find(version), version.size(), "-v0-");
    fs::rename(entry, folder_ / ("cache/" + name));
    expect_equal(features(), truth_);
    EXPECT_EQ(entries().size(), 2U);
}

TEST_F(FeatureCache, AFolderThatCannotBeWrittenIsNoObstacle) {
    mesh_files::write_bytes(folder_ / "file", "in the way");
    expect_equal(cached_features(mesh_, small_options(), folder_ / "file"), truth_);
    expect_equal(cached_features(mesh_, small_options(), {}), truth_);
    features();
    const fs::path entry = entries().front();
    fs::remove(entry);
    fs::create_directories(entry / "folder in the way");
    expect_equal(features(), truth_);
}

}  // namespace
}  // namespace exemplar
