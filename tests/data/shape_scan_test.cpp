#include "host/data/catalog/shape_scan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/core/errors.h"
#include "host/data/catalog/worker_folder.h"
#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using mesh_files::error_of;
using mesh_files::write_bytes;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* k_triangle = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

class ScanTest : public testing::Test {
  protected:
    void mesh(const std::string& name) const {
        fs::create_directories((folder_ / name).parent_path());
        write_bytes(folder_ / name, k_triangle);
    }
    std::vector<std::string> found(const std::string& below = ".") {
        std::vector<std::string> names;
        left_out_.clear();
        find_shapes(
            folder_ / below, [&](const FoundShape& shape) { names.push_back(shape.relative.string()); },
            [&](const fs::path& path, const std::string& why) {
                left_out_.push_back(path.filename().string());
                EXPECT_NE(why, "");
            });
        return names;
    }
    TemporaryFolder folder_;
    std::vector<std::string> left_out_;
};

TEST_F(ScanTest, FindsMeshesInAllFoldersInNaturalOrder) {
    for (const char* name : {"b/10.off", "b/2.off", "a.ply", "a/x.OBJ", "a/b/c/d.stl", "notes.txt", "a/x.mtl",
                             ".hidden.off", ".cache/y.off"})
        mesh(name);
    EXPECT_THAT(found(), ElementsAre("a.ply", "a/x.OBJ", "a/b/c/d.stl", "b/2.off", "b/10.off"));
    EXPECT_THAT(found("b"), ElementsAre("2.off", "10.off"));
    EXPECT_THROW(found("c"), DataError);
}

TEST_F(ScanTest, LinksLeadNowhereElse) {
    const TemporaryFolder outside;
    write_bytes(outside / "secret.off", k_triangle);
    fs::create_directories(outside / "more");
    write_bytes(outside / "more/x.off", k_triangle);
    mesh("in/a.off");
    fs::create_symlink(outside / "secret.off", folder_ / "in/stolen.off");
    fs::create_symlink("a.off", folder_ / "in/same.off");
    fs::create_directory_symlink(outside / "more", folder_ / "in/more");
    fs::create_directory_symlink(folder_ / "in", folder_ / "in/circle");
    fs::create_symlink("nowhere.off", folder_ / "in/dangling.off");
    ASSERT_EQ(mkfifo((folder_ / "in/pipe.off").c_str(), 0600), 0);
    EXPECT_THAT(found("in"), ElementsAre("a.off", "same.off"));
    EXPECT_THAT(left_out_, ElementsAre("stolen.off"));
}

TEST_F(ScanTest, WhatWasWrittenIsNoInput) {
    mesh("a.off");
    mesh("out/labeled/a.ply");
    write_bytes(folder_ / "out" / k_output_mark, "");
    EXPECT_THAT(found(), ElementsAre("a.off"));
    EXPECT_THAT(error_of<DataError>([&] { found("out"); }), HasSubstr(k_output_mark));
    EXPECT_THAT(found("out/labeled"), ElementsAre("a.ply"));
}

TEST_F(ScanTest, AFolderThatCannotBeReadIsLeftOut) {
    mesh("a.off");
    mesh("locked/b.off");
    mesh("z/c.off");
    fs::permissions(folder_.path(), fs::perms::all);
    fs::permissions(folder_ / "locked", fs::perms::none);
    const uid_t user = geteuid(), nobody = 65534;
    if (user == 0) {  // root may read every folder
        ASSERT_EQ(seteuid(nobody), 0);
    }
    EXPECT_THAT(found(), ElementsAre("a.off", "z/c.off"));
    EXPECT_THAT(left_out_, ElementsAre("locked"));
    EXPECT_THROW(found("locked"), DataError);
    if (user == 0) {
        ASSERT_EQ(seteuid(user), 0);
    }
    fs::permissions(folder_ / "locked", fs::perms::owner_all);
}

TEST_F(ScanTest, DescribesGoodAndBadFiles) {
    constexpr std::size_t k_memory = 1 << 20;
    mesh("a.off");
    const CatalogShape good = describe_shape(folder_ / "a.off", k_memory);
    EXPECT_EQ(good.problem, "");
    EXPECT_EQ(good.vertices, 3);
    EXPECT_EQ(good.faces, 1);
    EXPECT_EQ(good.components, 1);
    EXPECT_EQ(good.bytes, static_cast<std::int64_t>(std::string_view(k_triangle).size()));
    EXPECT_EQ(good.hash.size(), 32u);
    EXPECT_EQ(good.hash, file_hash(folder_ / "a.off"));
    EXPECT_THAT(good.warnings, HasSubstr("boundary"));

    write_bytes(folder_ / "bad.off", "OFF\n3 1 0\n0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_THAT(describe_shape(folder_ / "bad.off", k_memory).problem, HasSubstr("bad.off:3"));
    write_bytes(folder_ / "nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
    EXPECT_NE(describe_shape(folder_ / "nan.off", k_memory).problem, "");
    write_bytes(folder_ / "empty.off", "");
    EXPECT_NE(describe_shape(folder_ / "empty.off", k_memory).problem, "");
    EXPECT_NE(describe_shape(folder_ / "missing.off", k_memory).problem, "");
    EXPECT_NE(describe_shape(folder_.path(), k_memory).problem, "");
    // A file without content, of a terabyte: not a byte of it is read.
    write_bytes(folder_ / "huge.off", "OFF");
    fs::resize_file(folder_ / "huge.off", std::uintmax_t{1} << 40);
    EXPECT_THAT(describe_shape(folder_ / "huge.off", k_memory).problem, HasSubstr("more than can be read"));
    const std::string gltf =
        R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "beside.bin", "byteLength": 2000000000}]})";
    write_bytes(folder_ / "small.gltf", gltf);
    EXPECT_THAT(describe_shape(folder_ / "small.gltf", k_memory).problem, HasSubstr("more than can be read"));
}

TEST_F(ScanTest, EqualContentHasEqualHashes) {
    write_bytes(folder_ / "a", std::string(3'000'000, 'a'));
    write_bytes(folder_ / "b", std::string(3'000'000, 'a'));
    write_bytes(folder_ / "c", std::string(2'999'999, 'a') + "b");
    EXPECT_EQ(file_hash(folder_ / "a"), file_hash(folder_ / "b"));
    EXPECT_NE(file_hash(folder_ / "a"), file_hash(folder_ / "c"));
    write_bytes(folder_ / "e", "");
    EXPECT_EQ(file_hash(folder_ / "e"), "99aa06d3014798d86001c324468d497f");  // of XXH3-128, as its authors say
}

TEST(WorkerFolder, OfTheLivingStaysAndOfTheDeadGoes) {
    const TemporaryFolder out;
    WorkerFolder first(out.path());
    EXPECT_TRUE(WorkerFolder::may_be_alive(out.path(), first.id()));
    const pid_t child = fork();
    if (child == 0) {
        const WorkerFolder killed(out.path());
        write_bytes(killed.path() / "half", "x");
        write_bytes(out / "child", killed.id());
        _exit(0);  // nothing is cleaned up
    }
    int status = 0;
    waitpid(child, &status, 0);
    const std::string dead = read_file(out / "child");
    EXPECT_TRUE(fs::exists(out.path() / ".work" / dead / "half"));
    EXPECT_FALSE(WorkerFolder::may_be_alive(out.path(), dead));
    {
        const WorkerFolder second(out.path());
        EXPECT_NE(second.id(), first.id());
        EXPECT_FALSE(fs::exists(out.path() / ".work" / dead));
        EXPECT_TRUE(fs::exists(first.path()));
    }
    EXPECT_FALSE(WorkerFolder::may_be_alive(out.path(), "../somewhere"));
}

TEST(WorkerFolder, OfAnotherMachineStays) {
    const TemporaryFolder out;
    const std::string own = WorkerFolder(out.path()).id();
    // This machine's name and more, as if it were the beginning of the other's.
    const std::string other = own.substr(0, own.rfind('-', own.rfind('-') - 1)) + "-1-4711-0123abcd";
    fs::create_directory(out / ".work" / other);
    write_bytes(out / ".work" / (other + ".lock"), "");
    const WorkerFolder next(out.path());
    EXPECT_TRUE(fs::exists(out / ".work" / other));
}

TEST(OutputFolder, IsMadeBelowTheOutputAndThroughNoLink) {
    const TemporaryFolder out, outside;
    EXPECT_EQ(make_output_folder(out.path(), "a/b/c"), out / "a/b");
    EXPECT_TRUE(fs::is_directory(out / "a/b"));
    EXPECT_EQ(make_output_folder(out.path(), "c"), out.path());
    fs::create_directory_symlink(outside.path(), out / "link");
    EXPECT_THAT(error_of<DataError>([&] { make_output_folder(out.path(), "link/c"); }), HasSubstr("is no folder"));
    write_bytes(out / "file", "");
    EXPECT_THROW(make_output_folder(out.path(), "file/c"), DataError);
    EXPECT_THROW(make_output_folder(out.path(), "../c"), DataError);
}

}  // namespace
}  // namespace exemplar
