#include "host/data/safetensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <filesystem>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/random.h"
#include "tests/support/mesh_files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

using mesh_files::write_bytes;

/// A file with this header and data, whatever they are.
std::string file_of(const std::string& header, const std::string& data) {
    std::uint64_t size = header.size();
    std::string bytes(sizeof(size), '\0');
    std::memcpy(bytes.data(), &size, sizeof(size));
    return bytes + header + data;
}

TensorFile small_file() {
    TensorFile file;
    file.metadata["kind"] = "test";
    file.add("weights", {2, 2}, std::vector<float>{1, 2, 3, 4});
    file.add("index", {3}, std::vector<std::uint32_t>{7, 8, 9});
    return file;
}

TEST(Safetensors, GoldenBytes) {
    const TemporaryFolder folder;
    const fs::path path = folder / "golden.safetensors";
    write_safetensors(path, small_file());
    const std::string header =
        R"({"__metadata__":{"kind":"test"},"index":{"data_offsets":[0,12],"dtype":"U32","shape":[3]},)"
        R"("weights":{"data_offsets":[12,28],"dtype":"F32","shape":[2,2]}})";
    const std::string padded = header + std::string((8 - header.size() % 8) % 8, ' ');
    const std::string data("\x07\0\0\0\x08\0\0\0\x09\0\0\0\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\x80\x40", 28);
    EXPECT_EQ(read_file(path), file_of(padded, data));
}

TEST(Safetensors, ArraysAreReadWhereverTheyLie) {
    const TemporaryFolder folder;
    TensorFile file;
    file.add("a byte", {1}, std::vector<std::uint8_t>{5});
    file.add("after it", {2}, std::vector<float>{0.5F, -2});
    file.add("none there", {0}, std::vector<float>{});
    write_safetensors(folder / "odd.safetensors", file);
    const TensorFile back = read_safetensors(folder / "odd.safetensors");
    std::vector<float> values = back.get<float>("after it", {2}, 100);
    EXPECT_EQ(values, (std::vector<float>{0.5F, -2}));
    const float* before = values.data();
    values.resize(102);
    EXPECT_EQ(values.data(), before);
    EXPECT_TRUE(back.get<float>("none there").empty());
}

TEST(Safetensors, ArraysOutliveTheirFile) {
    const TemporaryFolder folder;
    const fs::path path = folder / "old.safetensors";
    write_safetensors(path, small_file());
    const std::array old{read_safetensors(path), map_safetensors(path)};
    TensorFile changed;
    changed.add("weights", {1}, std::vector<float>{9});
    write_safetensors(path, changed);
    for (const TensorFile& file : old) EXPECT_EQ(file.get<float>("weights"), (std::vector<float>{1, 2, 3, 4}));
    EXPECT_EQ(map_safetensors(path).get<float>("weights"), (std::vector<float>{9}));
    fs::remove(path);
    for (const TensorFile& file : old) EXPECT_EQ(file.get<float>("weights"), (std::vector<float>{1, 2, 3, 4}));
    EXPECT_THROW(map_safetensors(path), ModelError);
}

TEST(Safetensors, RoundTripWithEmptyArrays) {
    const TemporaryFolder folder;
    const fs::path path = folder / "round.safetensors";
    TensorFile file = small_file();
    file.add("nothing", {0, 5}, std::vector<float>{});
    write_safetensors(path, file);
    const TensorFile back = read_safetensors(path);
    EXPECT_EQ(back.get<float>("weights", {2, 2}), (std::vector<float>{1, 2, 3, 4}));
    EXPECT_EQ(back.get<std::uint32_t>("index", {TensorFile::k_any}), (std::vector<std::uint32_t>{7, 8, 9}));
    EXPECT_TRUE(back.get<float>("nothing", {0, 5}).empty());
    EXPECT_EQ(back.meta("kind"), "test");
    EXPECT_THROW((void)back.get<float>("index"), ModelError);
    EXPECT_THROW((void)back.get<float>("weights", {4}), ModelError);
    EXPECT_THROW((void)back.get<float>("absent"), ModelError);
    EXPECT_THROW((void)back.meta("absent"), ModelError);
}

TEST(Safetensors, DamagedFilesAreModelErrors) {
    const std::string good = R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})";
    const std::vector<std::string> bad{
        "",
        "short",
        std::string("\xff\xff\xff\xff\xff\xff\xff\x7f", 8) + "{}",
        file_of("", ""),
        file_of("[]", ""),
        file_of("{\"a\":1}", ""),
        file_of("{", ""),
        file_of(good, "abc"),
        file_of(good, "abcde"),
        file_of(R"({"a":{"dtype":"F32","shape":[2],"data_offsets":[0,4]}})", "abcd"),
        file_of(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},)"
                R"("b":{"dtype":"F32","shape":[1],"data_offsets":[0,4]}})",
                "abcdabcd"),
        file_of(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[4,8]}})", "abcdabcd"),
        file_of(R"({"a":{"dtype":"F99","shape":[1],"data_offsets":[0,4]}})", "abcd"),
        file_of(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[4,0]}})", "abcd"),
        file_of(R"({"a":{"dtype":"F32","shape":[4611686018427387905],"data_offsets":[0,4]}})", "abcd"),
        file_of(R"({"a":{"dtype":"F32","shape":[-1],"data_offsets":[0,4]}})", "abcd"),
        file_of(R"({"a":{"dtype":"F32","shape":"x","data_offsets":[0,4]}})", "abcd"),
        file_of(R"({"a":{"dtype":"F32","shape":[1],"data_offsets":[0,4]},"__metadata__":{"k":5}})", "abcd"),
    };
    const TemporaryFolder folder;
    const fs::path path = folder / "bad.safetensors";
    for (const std::string& bytes : bad) {
        write_bytes(path, bytes);
        EXPECT_THROW(read_safetensors(path), ModelError) << bytes;
    }
    EXPECT_THROW(read_safetensors("/nowhere/x.safetensors"), ModelError);
}

TEST(Safetensors, MutationsNeverCrash) {
    const TemporaryFolder folder;
    const fs::path path = folder / "fuzz.safetensors";
    write_safetensors(path, small_file());
    const std::string good = read_file(path);
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        std::string bytes = good.substr(0, random.uniform() < 0.3 ? random.index(good.size()) : good.size());
        for (std::size_t flips = random.index(4); flips > 0 && !bytes.empty(); --flips)
            bytes[random.index(bytes.size())] = static_cast<char>(random.next());
        write_bytes(path, bytes);
        try {
            const TensorFile file = read_safetensors(path);
            (void)file.get<float>("weights", {2, 2});
        } catch (const ModelError& error) {
            EXPECT_THAT(error.what(), testing::HasSubstr("fuzz.safetensors"));
        }
    }
}

}  // namespace
}  // namespace exemplar
