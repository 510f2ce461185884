// Damaged files of every format: a reader either throws the error of its kind, in one line, or returns a mesh that
// keeps the promises of TriangleMesh; and it never takes much more memory than the file's size.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "host/mesh/io_formats.h"
#include "host/mesh/validate.h"
#include "tests/fuzz/allocation.h"
#include "tests/fuzz/mutate.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

using mesh_files::Sample;

MeshFile read_in_memory(const std::string& file_name, const std::string& bytes) {
    if (file_name.ends_with(".off")) return mesh_io::read_off(bytes, file_name);
    if (file_name.ends_with(".obj")) return mesh_io::read_obj(bytes, file_name);
    if (file_name.ends_with(".ply")) return mesh_io::read_ply(bytes, file_name);
    if (file_name.ends_with(".stl")) return mesh_io::read_stl(bytes, file_name);
    return mesh_io::read_gltf(bytes, file_name, "no/such/folder");
}

void expect_promises(const MeshFile& file) {
    const TriangleMesh& mesh = file.mesh;
    for (const Face& face : mesh.faces)
        for (std::uint32_t corner : face) ASSERT_LT(corner, mesh.vertex_count());
    ASSERT_TRUE(mesh.source_face.empty() || mesh.source_face.size() == mesh.face_count());
    ASSERT_TRUE(!mesh.source_face.empty() || mesh.faces.empty() || mesh.source_face_count == mesh.face_count());
    for (std::uint32_t source : mesh.source_face) ASSERT_LT(source, mesh.source_face_count);
    if (file.labels) {
        ASSERT_EQ(file.labels->label.size(), mesh.source_face_count);
        for (std::int32_t label : file.labels->label) {
            ASSERT_GE(label, -1);
            ASSERT_LT(label, static_cast<std::int64_t>(file.labels->names.size()));
        }
    }
    validate_mesh(mesh).messages();
}

/// Reads damaged bytes; returns whether they still made a mesh.
bool survives(const std::string& file_name, const std::string& bytes) {
    const std::size_t before = fuzz::live_bytes();
    fuzz::reset_peak();
    bool is_mesh = false;
    try {
        const MeshFile file = read_in_memory(file_name, bytes);
        EXPECT_LE(fuzz::peak_bytes() - before, 256 * 1024 + 64 * bytes.size());
        expect_promises(file);
        is_mesh = true;
    } catch (const MeshError& error) {
        EXPECT_LE(fuzz::peak_bytes() - before, 256 * 1024 + 64 * bytes.size());
        const std::string message = error.what();
        EXPECT_TRUE(message.starts_with(file_name)) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
    return is_mesh;
}

/// More rounds, for a long search: EXEMPLAR_FUZZ_ROUNDS.
int fuzz_rounds() {
    const char* const rounds = std::getenv("EXEMPLAR_FUZZ_ROUNDS");
    return rounds ? std::atoi(rounds) : 4000;
}

#ifndef __SANITIZE_ADDRESS__
TEST(Allocation, PeakIsCounted) {
    const std::size_t before = fuzz::live_bytes();
    fuzz::reset_peak();
    {
        const std::vector<char> megabyte(1 << 20, 'x');
        EXPECT_GE(fuzz::live_bytes() - before, megabyte.size());
    }
    EXPECT_GE(fuzz::peak_bytes() - before, std::size_t{1} << 20);
    EXPECT_LT(fuzz::live_bytes() - before, std::size_t{1} << 20);
}
#endif

class MeshFileFuzz : public testing::TestWithParam<Sample> {};

TEST_P(MeshFileFuzz, DamageGivesAMeshErrorOrAValidMesh) {
    const Sample& sample = GetParam();
    ASSERT_TRUE(survives(sample.file_name, sample.bytes));
    Random random(20240607);
    const int rounds = fuzz_rounds();
    int meshes = 0;
    for (int round = 0; round < rounds; ++round) {
        std::string bytes = sample.bytes;
        for (std::size_t times = 1 + random.index(3); times > 0; --times)
            bytes = fuzz::damaged(std::move(bytes), random);
        meshes += survives(sample.file_name, bytes);
        if (HasFailure()) FAIL() << "round " << round << ":\n" << bytes;
    }
    // The damage must neither break every file nor none, or the test would see only one side of the reader.
    EXPECT_GT(meshes, rounds / 100);
    EXPECT_LT(meshes, rounds - rounds / 100);
}

TEST_P(MeshFileFuzz, EveryTruncationIsHandled) {
    const Sample& sample = GetParam();
    for (std::size_t size = 0; size < sample.bytes.size(); ++size) {
        survives(sample.file_name, sample.bytes.substr(0, size));
        if (HasFailure()) FAIL() << "cut after " << size << " bytes";
    }
}

INSTANTIATE_TEST_SUITE_P(AllFormats, MeshFileFuzz, testing::ValuesIn(mesh_files::samples()), [](const auto& sample) {
    std::string name = sample.param.file_name;
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
});

/// The reader must throw nothing but DataError.
template <typename Read>
void fuzz_data_file(const std::string& text, Read&& read) {
    const mesh_files::TemporaryFolder folder;
    Random random(77);
    int accepted = 0;
    constexpr int k_rounds = 300;
    for (int round = 0; round < k_rounds; ++round) {
        mesh_files::write_bytes(folder / "x", fuzz::damaged(text, random));
        try {
            read(folder / "x");
            ++accepted;
        } catch (const DataError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
        }
    }
    EXPECT_GT(accepted, 0);
    EXPECT_LT(accepted, k_rounds);
}

TEST(LabelFileFuzz, LabelsTxt) {
    fuzz_data_file("torso\n1 2 3 \nupper arm\n\nleg\n4 5 6 7 8\n", [](const auto& path) {
        for (std::int32_t label : read_labels_txt(path, 8).label) EXPECT_GE(label, 0);
    });
}

TEST(LabelFileFuzz, Seg) {
    fuzz_data_file("0\n0\n1\n2\n2\n10\n0\n3\n", [](const auto& path) {
        for (std::int32_t segment : read_seg(path, 8)) EXPECT_GE(segment, 0);
    });
}

}  // namespace
}  // namespace exemplar
