#include "host/data/result_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <set>
#include <thread>

#include "tests/support/mesh_files.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using mesh_files::error_of;
using mesh_files::write_bytes;

constexpr int k_version = 3;
constexpr std::size_t k_entry_bytes = 4000;  ///< of data; the file has a header, too
constexpr std::uint64_t k_unbounded = 1'000'000'000;

std::string entry_name(unsigned number) {
    return fmt::format("{:032x}-v3.safetensors", number);
}

TensorFile entry_of(unsigned number, std::size_t bytes = k_entry_bytes) {
    TensorFile file;
    file.metadata["number"] = std::to_string(number);
    file.add("data", {bytes}, std::vector<std::uint8_t>(bytes, static_cast<std::uint8_t>(number)));
    return file;
}

class ResultCache : public testing::Test {
  protected:
    fs::path path(unsigned number) const { return folder_ / entry_name(number); }
    void write(unsigned number, std::uint64_t max_bytes) const {
        write_cache_entry(path(number), k_version, entry_of(number), max_bytes);
    }
    /// Whether the entry is there; if it is, it must be the right one.
    bool read(unsigned number) const {
        std::vector<std::uint8_t> data;
        std::string told;
        const bool found = read_cache_entry(path(number), k_version, [&](const TensorFile& file) {
            data = file.get<std::uint8_t>("data");
            told = file.meta("number");
        });
        if (found) {
            EXPECT_EQ(told, std::to_string(number));
            EXPECT_EQ(data, std::vector<std::uint8_t>(k_entry_bytes, static_cast<std::uint8_t>(number)));
        }
        return found;
    }
    /// As if it had been used so many seconds ago.
    static void make_older(const fs::path& file, std::time_t seconds) {
        const timespec then{std::time(nullptr) - seconds, 0};
        const timespec times[2] = {then, then};
        ASSERT_EQ(utimensat(AT_FDCWD, file.c_str(), times, 0), 0);
    }
    std::set<std::string> names() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder_.path())) names.insert(entry.path().filename());
        return names;
    }
    std::uint64_t bytes() const {
        std::uint64_t sum = 0;
        for (const std::string& name : names())
            if (name.ends_with(".safetensors")) sum += fs::file_size(folder_ / name);
        return sum;
    }
    /// Entries 0, 1, ..., each an hour older than the one before.
    void write_aging(unsigned count) const {
        for (unsigned i = 0; i < count; ++i) {
            write(i, k_unbounded);
            make_older(path(i), 3600 * (i + 1));
        }
    }
    TemporaryFolder folder_;
};

TEST_F(ResultCache, WhatWasNotUsedForLongestGoesFirst) {
    write_aging(6);
    const std::uint64_t each = bytes() / 6;
    trim_cache(folder_.path(), 5 * each, {});  // 90 % of five are four
    EXPECT_EQ(names(), (std::set<std::string>{entry_name(0), entry_name(1), entry_name(2), entry_name(3)}));
    EXPECT_TRUE(read(3));
    EXPECT_FALSE(read(4));
}

TEST_F(ResultCache, ReadingIsUsing) {
    write_aging(6);
    const std::uint64_t each = bytes() / 6;
    EXPECT_TRUE(read(5));
    trim_cache(folder_.path(), 5 * each, {});
    EXPECT_EQ(names(), (std::set<std::string>{entry_name(0), entry_name(1), entry_name(2), entry_name(5)}));
}

TEST_F(ResultCache, AnEntryOfAnotherVersionIsNotUsed) {
    write_aging(2);
    EXPECT_FALSE(read_cache_entry(path(1), k_version + 1, [](const TensorFile&) {}));
    trim_cache(folder_.path(), bytes() - 1, {});
    EXPECT_EQ(names(), std::set<std::string>{entry_name(0)});
}

TEST_F(ResultCache, AFolderWithinItsBoundKeepsAll) {
    write_aging(4);
    trim_cache(folder_.path(), bytes(), {});
    EXPECT_EQ(names().size(), 4U);
    trim_cache(folder_.path(), bytes() - 1, {});
    EXPECT_EQ(names().size(), 3U);
}

TEST_F(ResultCache, TheNewestStaysWhateverItsAge) {
    write_aging(4);
    trim_cache(folder_.path(), 1, path(3));
    EXPECT_EQ(names(), std::set<std::string>{entry_name(3)});
}

TEST_F(ResultCache, WritingKeepsTheBound) {
    constexpr std::uint64_t k_bound = 50'000;  // each entry is more than a hundredth of it
    for (unsigned i = 0; i < 60; ++i) {
        write(i, k_bound);
        EXPECT_TRUE(read(i)) << i;
        EXPECT_LE(bytes(), k_bound) << i;
    }
    EXPECT_GE(bytes(), k_bound / 2);
}

TEST_F(ResultCache, SmallEntriesKeepTheBoundRoughly) {
    constexpr unsigned k_entries = 600;
    write(0, k_unbounded);
    const std::uint64_t each = bytes(), bound = 120 * each;
    std::uint64_t most = 0;
    for (unsigned i = 0; i < k_entries; ++i) {
        write(i, bound);
        if (i % 8 == 0) most = std::max(most, bytes());
    }
    EXPECT_GT(most, bound);  // not listed after each
    EXPECT_LT(most, 2 * bound);
    EXPECT_GT(bytes(), bound / 2);
}

TEST_F(ResultCache, AnEntryAboveTheBoundIsNotWritten) {
    write(1, k_unbounded);
    write_cache_entry(path(2), k_version, entry_of(2, 20'000), 10'000);
    write(3, 0);
    write_cache_entry(path(4), k_version, entry_of(4, 0), 0);
    EXPECT_EQ(names(), std::set<std::string>{entry_name(1)});
}

TEST_F(ResultCache, ForeignFilesStay) {
    const std::string foreign[] = {
        "model.safetensors",
        "0123456789abcdef0123456789abcdeg-v3.safetensors",
        "0123456789abcdef0123456789abcdef.safetensors",
        "notes.txt",
        "notes.tmp",
        entry_name(7) + ".bak",
    };
    for (const std::string& name : foreign) {
        write_bytes(folder_ / name, std::string(k_entry_bytes, 'x'));
        make_older(folder_ / name, 1'000'000);
    }
    fs::create_directories(folder_ / entry_name(8) / "inside");
    fs::create_symlink(folder_ / "notes.txt", folder_ / entry_name(9));
    fs::create_directories(folder_ / "below");
    write_cache_entry(folder_ / "below" / entry_name(10), k_version, entry_of(10), k_unbounded);
    const std::set<std::string> before = names();
    write_aging(1);
    trim_cache(folder_.path(), 1, {});
    EXPECT_EQ(names(), before);
    EXPECT_TRUE(fs::exists(folder_ / "below" / entry_name(10)));
}

TEST_F(ResultCache, WhatDeadWritersLeftGoesAfterADay) {
    const std::string young = entry_name(1) + ".123.0.tmp", old = entry_name(1) + ".124.7.tmp";
    for (const std::string& name : {young, old}) write_bytes(folder_ / name, "half");
    make_older(folder_ / young, 3600);
    make_older(folder_ / old, 25 * 3600);
    trim_cache(folder_.path(), k_unbounded, {});
    EXPECT_EQ(names(), std::set<std::string>{young});
}

TEST_F(ResultCache, DamagedEntriesAreMisses) {
    write(1, k_unbounded);
    const std::string whole = read_file(path(1));
    for (const std::string& bytes :
         {std::string(), std::string("no entry"), whole.substr(0, whole.size() / 2), whole + "more"}) {
        write_bytes(path(1), bytes);
        EXPECT_FALSE(read(1));
    }
    for (std::size_t place = 0; place < whole.size(); place += 97) {
        std::string flipped = whole;
        flipped[place] = static_cast<char>(flipped[place] ^ 0x20);
        write_bytes(path(1), flipped);
        EXPECT_FALSE(read(1)) << place;
    }
    write(1, k_unbounded);
    EXPECT_TRUE(read(1));
}

TEST_F(ResultCache, AWriteThatFailsLeavesNothing) {
    // As on a full disk: the file cannot grow beyond this.
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit full = before;
    full.rlim_cur = 100'000;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
    write_cache_entry(path(1), k_version, entry_of(1, 200'000), k_unbounded);
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(names(), std::set<std::string>());
}

TEST_F(ResultCache, WritersAndReadersMayUseItAtOnce) {
    constexpr unsigned k_threads = 4, k_rounds = 150, k_numbers = 40;
    constexpr std::uint64_t k_bound = 60'000;  // a third of what is written
    std::vector<std::thread> threads;
    std::vector<unsigned> found(k_threads, 0);
    for (unsigned t = 0; t < k_threads; ++t)
        threads.emplace_back([&, t] {
            for (unsigned i = 0; i < k_rounds; ++i) {
                const unsigned number = (i * (2 * t + 1) + 7 * t) % k_numbers;
                if (read(number))
                    ++found[t];
                else
                    write(number, k_bound);
            }
        });
    for (std::thread& thread : threads) thread.join();
    write(k_numbers, k_bound);
    EXPECT_LE(bytes(), k_bound);
    EXPECT_GT(found[0] + found[1] + found[2] + found[3], 0U);
    for (const std::string& name : names()) EXPECT_TRUE(name.ends_with(".safetensors")) << name;
}

TEST_F(ResultCache, AReaderKeepsWhatIsRemoved) {
    write(1, k_unbounded);
    const bool found = read_cache_entry(path(1), k_version, [&](const TensorFile& file) {
        trim_cache(folder_.path(), 1, {});
        EXPECT_FALSE(fs::exists(path(1)));
        EXPECT_EQ(file.get<std::uint8_t>("data"), std::vector<std::uint8_t>(k_entry_bytes, 1));
    });
    EXPECT_TRUE(found);
}

TEST_F(ResultCache, AMissingFolderIsEmpty) {
    EXPECT_NO_THROW(trim_cache(folder_ / "none", 1, {}));
    EXPECT_NO_THROW(trim_cache({}, 1, {}));
}

/// Sets the variable while it lives.
class BoundVariable {
  public:
    explicit BoundVariable(const char* value) {
        if (const char* before = std::getenv(k_name)) before_ = before;
        setenv(k_name, value, 1);
    }
    ~BoundVariable() { before_.empty() ? unsetenv(k_name) : setenv(k_name, before_.c_str(), 1); }
    BoundVariable(const BoundVariable&) = delete;
    BoundVariable& operator=(const BoundVariable&) = delete;

  private:
    static constexpr const char* k_name = "EXEMPLAR_CACHE_GB";
    std::string before_;
};

std::uint64_t bound_of(const char* value) {
    const BoundVariable variable(value);
    return cache_bound();
}

TEST(CacheBound, IsReadFromTheEnvironment) {
    EXPECT_EQ(bound_of(""), 20'000'000'000U);
    EXPECT_EQ(bound_of("3"), 3'000'000'000U);
    EXPECT_EQ(bound_of("0.5"), 500'000'000U);
    EXPECT_EQ(bound_of("0"), 0U);
}

TEST(CacheBound, RefusesWhatIsNoSize) {
    for (const char* value : {"-1", "twenty", "20GB", "nan", "inf", "1e30", " "}) {
        const std::string error = error_of<UsageError>([&] { bound_of(value); });
        EXPECT_NE(error.find("EXEMPLAR_CACHE_GB"), std::string::npos) << error;
    }
}

TEST_F(ResultCache, TheEnvironmentBoundsWriting) {
    const BoundVariable variable("0");
    write_cache_entry(path(1), k_version, entry_of(1));
    EXPECT_EQ(names(), std::set<std::string>());
}

}  // namespace
}  // namespace exemplar
