#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/core/random.h"
#include "host/core/statistics.h"
#include "host/core/text.h"
#include "tests/support/mesh_files.h"
#include "tests/support/temporary_folder.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

TEST(Files, WritesWholeFilesAndCreatesFolders) {
    const TemporaryFolder folder;
    const fs::path path = folder / "a" / "b.txt";
    write_file_atomically(path, [](std::ostream& out) { out << "hello"; });
    EXPECT_EQ(read_file(path), "hello");
}

TEST(Files, AFailedWriteLeavesTheOldFileAndNoTemporary) {
    const TemporaryFolder folder;
    const fs::path path = folder / "b.txt";
    write_file_atomically(path, [](std::ostream& out) { out << "old"; });
    EXPECT_THROW(write_file_atomically(path,
                                       [](std::ostream& out) {
                                           out << "half";
                                           throw Interrupted();
                                       }),
                 Interrupted);
    EXPECT_EQ(read_file(path), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(path.parent_path()), fs::directory_iterator()), 1);
}

TEST(Files, LinksStayAndPipesAreNotReplaced) {
    const TemporaryFolder folder;
    write_file_atomically(folder / "real" / "b.txt", [](std::ostream& out) { out << "old"; });
    fs::create_symlink("real/b.txt", folder / "link.txt");
    write_file_atomically(folder / "link.txt", [](std::ostream& out) { out << "new"; });
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(read_file(folder / "real" / "b.txt"), "new");
    fs::create_symlink("/dev/null", folder / "null.txt");
    write_file_atomically(folder / "null.txt", [](std::ostream& out) { out << "gone"; });
    EXPECT_TRUE(fs::is_symlink(folder / "null.txt"));
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(Files, NobodysLinkIsWrittenThrough) {
    const TemporaryFolder folder;
    write_file_atomically(folder / "secret.txt", [](std::ostream& out) { out << "secret"; });
    for (int n = 0; n < 1000; ++n)  // as the temporary file would be called
        fs::create_symlink(folder / "secret.txt", folder / fmt::format("a.txt.{}.{}.tmp", getpid(), n));
    write_file_atomically(folder / "a.txt", [](std::ostream& out) { out << "hello"; });
    EXPECT_EQ(read_file(folder / "a.txt"), "hello");
    EXPECT_EQ(read_file(folder / "secret.txt"), "secret");
}

TEST(Files, PlacesThatCannotBeWrittenAreNamed) {
    try {
        write_file_atomically("/proc/exemplar/none.txt", [](std::ostream&) {});
        FAIL() << "no error";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("/proc/exemplar/none.txt"));
    }
}

TEST(Files, MissingFilesAndFoldersAreNamed) {
    try {
        read_file("/nowhere/model.bin");
        FAIL() << "no error";
    } catch (const DataError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("/nowhere/model.bin"));
    }
    EXPECT_THROW(read_file("/tmp"), DataError);
    EXPECT_THROW(read_file("/etc/passwd/below"), DataError);
    EXPECT_THROW(read_file("/" + std::string(5000, 'x')), DataError);
    if (fs::exists("/proc/self/mem")) {  // opens, but cannot be read
        EXPECT_THROW(read_file("/proc/self/mem"), DataError);
    }
}

TEST(Files, WhatIsLargerThanMemoryIsRefused) {
    const TemporaryFolder folder;
    std::ofstream(folder / "holes.off") << "OFF";
    std::error_code error;
    fs::resize_file(folder / "holes.off", std::uintmax_t{1} << 42, error);
    if (error) GTEST_SKIP() << "no file of 4 TB can be made here: " << error.message();
    EXPECT_THAT(mesh_files::error_of<DataError>([&] { read_file(folder / "holes.off"); }),
                testing::AllOf(testing::HasSubstr("holes.off"), testing::HasSubstr("GB of memory")));
}

TEST(Files, ViewsHaveTheContent) {
    const TemporaryFolder folder;
    const std::string text = "two\nlines";
    write_file_atomically(folder / "text.txt", [&](std::ostream& out) { out << text; });
    write_file_atomically(folder / "empty.txt", [](std::ostream&) {});
    const FileView view = view_file(folder / "text.txt");
    write_file_atomically(folder / "text.txt", [](std::ostream& out) { out << "replaced"; });
    EXPECT_EQ(view.content, text);
    EXPECT_EQ(view_file(folder / "empty.txt").content, "");
    EXPECT_FALSE(view_file("/proc/self/status").content.empty()) << "a file whose size is not known beforehand";
    EXPECT_THROW(view_file("/nowhere/model.bin"), DataError);
    EXPECT_THROW(view_file("/tmp"), DataError);
}

TEST(Text, SuggestsTheNearestWord) {
    const std::vector<std::string> words{"head", "torso", "upperLeg", "tail"};
    EXPECT_EQ(nearest_word("haed", words), "head");
    EXPECT_EQ(nearest_word("upper_leg", words), "upperLeg");
    EXPECT_EQ(nearest_word("Tail", words), "tail");
    EXPECT_EQ(nearest_word("wheel", words), "");
    EXPECT_EQ(suggestion("torsso", words), " (did you mean 'torso'?)");
    EXPECT_EQ(suggestion("anything", {}), "");
}

TEST(Text, CountsSwapsOfNeighborsAsOneMistake) {
    const std::vector<std::string> words{"abcdef", "badcxx"};
    EXPECT_EQ(nearest_word("badcfe", words), "badcxx") << "two letters differ; three swaps away from the other";
    EXPECT_EQ(nearest_word("abdcef", words), "abcdef") << "one swap";
    EXPECT_EQ(nearest_word("bcadef", std::vector<std::string>{"abcdef"}), "abcdef") << "one letter gone, one more";
    EXPECT_EQ(nearest_word("fedcba", std::vector<std::string>{"abcdef"}), "");
}

TEST(Files, SuggestsTheNearestFileThatIsThere) {
    const TemporaryFolder folder;
    for (const char* name : {"chair.off", "table.off"}) write_file_atomically(folder / name, [](std::ostream&) {});
    fs::create_symlink("nowhere.off", folder / "chair1.off");
    fs::create_symlink("table.off", folder / "tabla.off");
    const auto meant = [&](const char* name) { return " (did you mean '" + (folder / name).string() + "'?)"; };
    EXPECT_EQ(suggest_file(folder / "chair12.off"), meant("chair.off")) << "the nearer one is a link to nothing";
    EXPECT_EQ(suggest_file(folder / "tablaa.off"), meant("tabla.off"));
    EXPECT_EQ(suggest_file(folder / "chiar.off/"), meant("chair.off")) << "ends in a slash";
    EXPECT_EQ(suggest_file(folder / "none/chair.off"), "");
}

TEST(Text, SuggestsNothingForAHugeWordAndTakesNoMemoryForIt) {
    const std::string huge(std::size_t{1} << 24, 'x');  // comparing all letters with each other would take petabytes
    const std::vector<std::string> words{huge, "x"};
    EXPECT_EQ(nearest_word(huge, words), "");
    EXPECT_EQ(nearest_word("xx", words), "x");
}

TEST(Text, TellsUtf8FromOtherEncodings) {
    for (const char* good :
         {"", "leg", "Fl\xc3\xbcgel", "\xe2\x82\xac", "\xf0\x9f\xa6\xb5", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"})
        EXPECT_TRUE(is_utf8(good)) << good;
    // Latin-1; cut off; lone continuation; overlong; surrogate; beyond the last code point.
    for (const char* bad : {"Fl\xfcgel", "\xe2\x82", "\xc3", "a\x80", "\xc0\xaf", "\xe0\x80\xaf", "\xf0\x80\x80\x80",
                            "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xf8\x88\x80\x80\x80", "\xc3("})
        EXPECT_FALSE(is_utf8(bad)) << bad;
}

TEST(Text, LowersOnlyTheLettersAToZ) {
    EXPECT_EQ(lower_case("Cow_7.OFF"), "cow_7.off");
    EXPECT_EQ(lower_case("@[`{\xc3\x84"), "@[`{\xc3\x84") << "neighbors of the letters, and bytes of others";
}

// The examples of RFC 4648, section 10.
TEST(Text, Base64) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foob"), "Zm9vYg==");
    EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe"), "//4=") << "bytes above 127";
}

TEST(Text, CountsInSingularAndPlural) {
    EXPECT_EQ(counted(0, "pose"), "0 poses");
    EXPECT_EQ(counted(1, "pose"), "1 pose");
    EXPECT_EQ(counted(12, "pose"), "12 poses");
    EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
    EXPECT_EQ(counted(0, "vertex", "vertices"), "0 vertices");
}

TEST(Text, FormatsSeconds) {
    EXPECT_EQ(format_seconds(0.421), "0.42 s");
    EXPECT_EQ(format_seconds(3.14), "3.1 s");
    EXPECT_EQ(format_seconds(59.4), "59 s");
    EXPECT_EQ(format_seconds(200), "3 min 20 s");
    EXPECT_EQ(format_seconds(3900), "1 h 05 min");
}

TEST(Text, ControlsDoNothing) {
    EXPECT_EQ(without_controls("a\x1b[2Jb\nc\x7f \xc3\xa4"), "a?[2Jb?c? \xc3\xa4");
}

TEST(Random, IsTheSameSequenceEverywhere) {
    Random random(1);
    EXPECT_EQ(random.next(), 0x910a2dec89025cc1ULL);
    EXPECT_EQ(random.next(), 0xbeeb8da1658eec67ULL);
}

TEST(Random, MomentsAreRight) {
    Random random(7);
    double mean = 0, square = 0, normal_mean = 0, normal_square = 0;
    const int count = 100000;
    for (int i = 0; i < count; ++i) {
        const double u = random.uniform(), n = random.normal();
        ASSERT_GE(u, 0.0);
        ASSERT_LT(u, 1.0);
        mean += u, square += u * u, normal_mean += n, normal_square += n * n;
    }
    EXPECT_NEAR(mean / count, 0.5, 0.005);
    EXPECT_NEAR(square / count, 1.0 / 3, 0.005);
    EXPECT_NEAR(normal_mean / count, 0, 0.015);
    EXPECT_NEAR(normal_square / count, 1, 0.02);
}

TEST(Random, ForksDoNotDependOnEarlierDraws) {
    const Random parent(3);
    EXPECT_EQ(parent.fork(5).next(), parent.fork(5).next());
    EXPECT_NE(parent.fork(5).next(), parent.fork(6).next());
}

TEST(Parallel, EveryIndexRunsOnceForAnyThreadCount) {
    for (const std::size_t threads : {1UL, 2UL, 4UL}) {
        const ThreadLimit limit(threads);
        std::vector<std::atomic<int>> runs(1001);
        parallel_for(runs.size(), [&](std::size_t i) { ++runs[i]; });
        parallel_ranges(runs.size(), 64, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) ++runs[i];
        });
        for (const auto& count : runs) EXPECT_EQ(count, 2);
    }
}

TEST(Parallel, ErrorsReachTheCaller) {
    EXPECT_THROW(parallel_for(100,
                              [](std::size_t i) {
                                  if (i == 57) throw MeshError("57");
                              }),
                 MeshError);
}

TEST(EvenlySpaced, TakesTheFirstAndSkipsAlike) {
    const std::vector<int> items{0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    EXPECT_THAT(evenly_spaced(items, 4), testing::ElementsAre(0, 2, 5, 7));
    EXPECT_EQ(evenly_spaced(items, 10), items);
    EXPECT_EQ(evenly_spaced(items, 99), items);
    EXPECT_TRUE(evenly_spaced(items, 0).empty());
    EXPECT_TRUE(evenly_spaced(std::vector<int>{}, 3).empty());
}

TEST(Progress, TellsItsListenerFromAllThreadsAndLetsItEndTheTask) {
    std::atomic<std::size_t> steps = 0;
    Progress::set_listener([&](const ProgressState& state) {
        EXPECT_EQ(state.what, "counting");
        EXPECT_EQ(state.total, 100u);
        if (++steps == 40) throw Interrupted();
    });
    const auto count = [] {
        Progress progress("counting", 100);
        parallel_for(100, [&](std::size_t) { progress.advance(); });
    };
    EXPECT_THROW(count(), Interrupted);
    EXPECT_GE(steps, 40u);
    EXPECT_LT(steps, 100u);
    Progress::set_listener({});
    steps = 0;
    Progress::set_quiet(true);
    count();
    EXPECT_EQ(steps, 0u);
}

}  // namespace
}  // namespace exemplar
