#include "host/data/npy.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

TEST(Npy, WritesTheBytesOfTheFormat) {
    FeatureMatrix matrix;
    matrix.rows = 2;
    for (const float first : {1.0F, 2.0F, -0.5F}) {
        const std::span<float> column = matrix.add("f.x");
        column[0] = first;
        column[1] = 10.0F * first;
    }
    const TemporaryFolder folder;
    const std::filesystem::path path = folder / "golden.npy";
    write_npy(path, matrix);
    std::string expected("\x93NUMPY\x01\x00\x76\x00{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }",
                         10 + 59);
    expected.append(128 - 1 - expected.size(), ' ');
    expected.push_back('\n');
    // 1, 2, -0.5 and then 10, 20, -5, little endian.
    expected.append(std::string("\x00\x00\x80\x3f\x00\x00\x00\x40\x00\x00\x00\xbf", 12));
    expected.append(std::string("\x00\x00\x20\x41\x00\x00\xa0\x41\x00\x00\xa0\xc0", 12));
    EXPECT_EQ(read_file(path), expected);
    std::filesystem::remove_all(path.parent_path());
}

TEST(Npy, DataBeginAtAMultipleOf64Bytes) {
    for (const std::size_t rows : {0U, 1U, 999U, 123456U}) {
        FeatureMatrix matrix;
        matrix.rows = rows;
        matrix.add("f.x");
        const TemporaryFolder folder;
        const std::filesystem::path path = folder / "aligned.npy";
        write_npy(path, matrix);
        const std::string bytes = read_file(path);
        EXPECT_EQ((bytes.size() - rows * sizeof(float)) % 64, 0U);
        EXPECT_EQ(bytes[bytes.size() - rows * sizeof(float) - 1], '\n');
        std::filesystem::remove_all(path.parent_path());
    }
}

TEST(Npy, RepeatsAndReordersRows) {
    FeatureMatrix matrix;
    matrix.rows = 2;
    const std::span<float> column = matrix.add("f.x");
    column[0] = 1.0F, column[1] = 2.0F;
    const TemporaryFolder folder;
    write_npy(folder / "rows.npy", matrix, std::vector<std::uint32_t>{1, 0, 1});
    const std::string bytes = read_file(folder / "rows.npy");
    EXPECT_NE(bytes.find("'shape': (3, 1)"), std::string::npos);
    EXPECT_EQ(bytes.substr(bytes.size() - 12), std::string("\x00\x00\x00\x40\x00\x00\x80\x3f\x00\x00\x00\x40", 12));
}

TEST(Npy, NamesAPathThatCannotBeWritten) {
    FeatureMatrix matrix;
    EXPECT_THROW(write_npy("/proc/no_such_folder/x.npy", matrix), DataError);
}

}  // namespace
}  // namespace exemplar
