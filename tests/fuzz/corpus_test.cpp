// The readers' promises on every file that the fuzzers start from. corpus/READER/refused_* must be refused, all others
// accepted; what a fuzzer finds is mended and joins them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/fuzz/support/allocation.h"
#include "tests/fuzz/support/promises.h"
#include "tests/fuzz/support/readers.h"
#include "tests/support/import_files.h"

namespace exemplar::fuzz {

/// How GoogleTest shows a reader.
void PrintTo(const Reader& reader, std::ostream* out) {
    *out << reader.name;
}

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> corpus_of(const Reader& reader) {
    std::vector<fs::path> paths;
    for (const auto& entry : fs::directory_iterator(fs::path("tests/fuzz/corpus") / reader.name))
        paths.push_back(entry.path());
    std::ranges::sort(paths);
    return paths;
}

bool is_refused(const fs::path& path) {
    return path.filename().string().starts_with("refused_");
}

class Corpus : public testing::TestWithParam<Reader> {
  protected:
    void SetUp() override {
        if (GetParam().starts_process && !import_files::can_import())
            GTEST_SKIP() << "exemplar-import is not built; it needs libassimp-dev";
    }
};

TEST_P(Corpus, EveryFileIsAcceptedOrRefusedAsNamed) {
    std::size_t accepted = 0;
    const std::vector<fs::path> paths = corpus_of(GetParam());
    for (const fs::path& path : paths) {
        SCOPED_TRACE(path);
        accepted += !is_refused(path);
        try {
            EXPECT_EQ(GetParam().keeps_promises(read_file(path)), !is_refused(path));
        } catch (const BrokenPromise& broken) {
            ADD_FAILURE() << broken.what();
        }
    }
    EXPECT_GT(accepted, 0u);
    EXPECT_LT(accepted, paths.size());
}

TEST_P(Corpus, EveryFileMayBeCutAnywhere) {
    for (const fs::path& path : corpus_of(GetParam())) {
        const std::string content = read_file(path);
        const std::size_t step = GetParam().starts_process ? content.size() / 8 + 1 : 1;
        for (std::size_t size = 0; size < content.size(); size += step) {
            SCOPED_TRACE(path.string() + " cut after " + std::to_string(size) + " bytes");
            try {
                GetParam().keeps_promises(std::string_view(content).substr(0, size));
            } catch (const BrokenPromise& broken) {
                FAIL() << broken.what();
            }
            free_unwound_frames();
        }
    }
}

INSTANTIATE_TEST_SUITE_P(AllReaders, Corpus, testing::ValuesIn(readers().begin(), readers().end()),
                         [](const auto& reader) { return std::string(reader.param.name); });

TEST(Promises, BrokenOnesAreNoticed) {
    MeshFile file;
    file.mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    file.mesh.faces = {{0, 1, 2}};
    file.mesh.source_face_count = 1;
    file.labels = FaceLabels{{"leg"}, {0}};
    EXPECT_NO_THROW(require_promises(file));

    const auto expect_broken = [&](auto&& change) {
        MeshFile changed = file;
        change(changed);
        EXPECT_THROW(require_promises(changed), BrokenPromise);
    };
    expect_broken([](MeshFile& f) { f.mesh.faces[0][2] = 3; });
    expect_broken([](MeshFile& f) { f.mesh.source_face_count = 2; });
    expect_broken([](MeshFile& f) { f.mesh.source_face = {1}; });
    expect_broken([](MeshFile& f) { f.labels->label = {1}; });
    expect_broken([](MeshFile& f) { f.labels->label.clear(); });
    expect_broken([](MeshFile& f) { f.labels->names = {"two\nlines"}; });
    expect_broken([](MeshFile& f) { f.warnings = {"a bell \a"}; });
}

TEST(Promises, ErrorsAreTypedAndNameTheFile) {
    constexpr MemoryBound k_bound{1 << 16, 1};
    const auto fails_with = [&](const char* message) {
        return accepts<MeshError>("x.off", 0, k_bound, [&] { throw MeshError(message); });
    };
    EXPECT_FALSE(fails_with("x.off: is no mesh"));
    EXPECT_THROW(fails_with("is no mesh"), BrokenPromise);
    EXPECT_THROW(fails_with("x.off: two\nlines"), BrokenPromise);
    EXPECT_THROW(fails_with(""), BrokenPromise);
    EXPECT_THROW(accepts<MeshError>("x.off", 0, k_bound, [] { throw DataError("x.off: of another kind"); }), DataError);
}

TEST(Promises, MemoryIsCounted) {
    const auto reads_megabyte = [](std::size_t size) {
        return accepts<MeshError>("x.off", size, {1 << 16, 1}, [] { std::vector<char>(1 << 20, 'x').shrink_to_fit(); });
    };
    EXPECT_TRUE(reads_megabyte(1 << 20));
    EXPECT_THROW(reads_megabyte(1 << 19), BrokenPromise);
    const std::size_t before = live_bytes();
    const std::vector<char> kept(1 << 20, 'x');
    EXPECT_GE(live_bytes() - before, kept.size());
}

}  // namespace
}  // namespace exemplar::fuzz
