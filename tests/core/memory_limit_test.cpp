#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "host/core/files.h"
#include "host/core/memory_budget.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t k_invalid_index = std::numeric_limits<std::size_t>::max();

/// Control groups made up in a folder.
class MemoryLimit : public testing::Test {
  protected:
    void SetUp() override {
        root_ = fs::path(testing::TempDir()) /
                (std::string("memory_limit_") + testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(root_);
    }
    void TearDown() override { fs::remove_all(root_); }
    void put(const std::string& file, const std::string& text) const {
        write_file_atomically(root_ / file, [&](std::ostream& out) { out << text << '\n'; });
    }
    fs::path root_;
};

TEST_F(MemoryLimit, TheLeastOnTheWayCounts) {
    put("slurm/memory.max", "8000");
    put("slurm/job_7/memory.max", "3000");
    put("slurm/job_7/step_batch/memory.max", "max");
    put("slurm/job_8/memory.max", "10");
    EXPECT_EQ(memory_limit("0::/slurm/job_7/step_batch\n", root_), 3000U);
    EXPECT_EQ(memory_limit("0::/slurm\n", root_), 8000U);
    EXPECT_EQ(memory_limit("0::/slurm/job_8", root_), 10U);
    EXPECT_EQ(memory_limit("0::/\n", root_), k_invalid_index);
    EXPECT_EQ(memory_limit("", root_), k_invalid_index);
}

TEST_F(MemoryLimit, OfTheFirstVersionInItsOwnFolder) {
    put("memory/memory.limit_in_bytes", "9223372036854771712");  // how that version says "none"
    put("memory/slurm/uid_0/memory.limit_in_bytes", "5000");
    put("memory/slurm/uid_0/job_7/memory.limit_in_bytes", "6000");
    put("slurm/uid_0/memory.max", "1");  // not of this version
    const std::string others = "5:cpu,cpuacct:/slurm/uid_0\n3:memoryless:/slurm/uid_0\n";
    EXPECT_EQ(memory_limit(others + "4:memory:/slurm/uid_0/job_7\n", root_), 5000U);
    EXPECT_EQ(memory_limit(others + "4:hugetlb,memory:/slurm/uid_0\n0::/\n", root_), 5000U);
    EXPECT_EQ(memory_limit(others, root_), 9223372036854771712U);
}

TEST_F(MemoryLimit, InAContainerTheRootMayBeTheGroup) {
    put("memory.max", "700");
    EXPECT_EQ(memory_limit("0::/", root_), 700U);
    EXPECT_EQ(memory_limit("0::/only/outside", root_), 700U);
    EXPECT_EQ(memory_limit("0::/../../other", root_), 700U);
    EXPECT_EQ(memory_limit("", root_), 700U);
}

TEST_F(MemoryLimit, NamesMayHoldColonsAndSpaces) {
    put("a:b c/memory.max", "42");
    EXPECT_EQ(memory_limit("0::/a:b c\n", root_), 42U);
}

TEST_F(MemoryLimit, WhatIsNoNumberSetsNone) {
    put("damaged/memory.max", "many");
    put("empty/memory.max", "");
    EXPECT_EQ(memory_limit("0::/damaged\n0::/empty\nnonsense\n:\n", root_), k_invalid_index);
}

TEST(ResidentMemory, GrowsByWhatIsWrittenTo) {
    const std::size_t before = resident_memory(), bytes = std::size_t{64} << 20;
    ASSERT_GT(before, 0U);
    const std::vector<char> block(bytes, 'x');
    EXPECT_GT(resident_memory(), before + bytes / 2);
    EXPECT_LT(resident_memory(), before + 4 * bytes) << "the block has " << block.size();
}

}  // namespace
}  // namespace exemplar
