#include "gpu/runtime/record/hazards.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "host/core/random.h"

// The validation layer does not see a missing barrier between two dispatches of one pipeline on one buffer, so the
// rules are tested here by themselves.
namespace exemplar {
namespace {

constexpr VkPipelineStageFlags2 k_compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr VkAccessFlags2 k_read = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
constexpr VkAccessFlags2 k_write = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

VkBuffer buffer(std::uintptr_t id) {
    return reinterpret_cast<VkBuffer>(id);  // NOLINT(performance-no-int-to-ptr): a name, never used as an address
}

Access reading(std::uintptr_t id) {
    return {.buffer = buffer(id), .stage = k_compute, .reads = k_read};
}
Access writing(std::uintptr_t id) {
    return {.buffer = buffer(id), .stage = k_compute, .writes = k_write};
}
Access updating(std::uintptr_t id) {
    return {.buffer = buffer(id), .stage = k_compute, .reads = k_read, .writes = k_write};
}
Access copying_from(std::uintptr_t id) {
    return {.buffer = buffer(id), .stage = k_transfer, .reads = VK_ACCESS_2_TRANSFER_READ_BIT};
}

std::vector<Barrier> after(HazardTracker& tracker, std::initializer_list<Access> accesses) {
    return tracker.before({accesses.begin(), accesses.size()});
}

TEST(Hazards, FirstUseNeedsNoBarrier) {
    HazardTracker tracker;
    EXPECT_TRUE(after(tracker, {writing(1), reading(2)}).empty());
}

TEST(Hazards, ReadAfterWriteMakesTheWriteVisible) {
    HazardTracker tracker;
    after(tracker, {writing(1)});
    const auto barriers = after(tracker, {reading(1), writing(2)});
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_EQ(barriers[0].buffer, buffer(1));
    EXPECT_EQ(barriers[0].source_stage, k_compute);
    EXPECT_EQ(barriers[0].source_access, k_write);
    EXPECT_EQ(barriers[0].target_stage, k_compute);
    EXPECT_EQ(barriers[0].target_access, k_read);
}

TEST(Hazards, WriteAfterWriteOrdersMemory) {
    HazardTracker tracker;
    after(tracker, {writing(1)});
    const auto barriers = after(tracker, {writing(1)});
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_EQ(barriers[0].source_access, k_write);
    EXPECT_EQ(barriers[0].target_access, k_write);
}

TEST(Hazards, WriteAfterReadOrdersExecutionOnly) {
    HazardTracker tracker;
    after(tracker, {copying_from(1)});
    const auto barriers = after(tracker, {writing(1)});
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_EQ(barriers[0].source_stage, k_transfer);
    EXPECT_EQ(barriers[0].source_access, VK_ACCESS_2_NONE);
    EXPECT_EQ(barriers[0].target_stage, k_compute);
}

TEST(Hazards, ReadsAfterReadsNeedNothing) {
    HazardTracker tracker;
    after(tracker, {writing(1)});
    EXPECT_EQ(after(tracker, {reading(1)}).size(), 1u);
    EXPECT_TRUE(after(tracker, {reading(1)}).empty());
    EXPECT_TRUE(after(tracker, {reading(1), writing(2)}).empty());
}

TEST(Hazards, EveryReadingStageGetsItsOwnBarrier) {
    HazardTracker tracker;
    after(tracker, {writing(1)});
    EXPECT_EQ(after(tracker, {reading(1)}).size(), 1u);
    const auto barriers = after(tracker, {copying_from(1)});
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_EQ(barriers[0].source_access, k_write);
    EXPECT_EQ(barriers[0].target_stage, k_transfer);
    // A write waits for both readers.
    EXPECT_EQ(after(tracker, {writing(1)}).at(0).source_stage, k_compute | k_transfer);
}

TEST(Hazards, RepeatedUpdatesAreChained) {
    HazardTracker tracker;
    EXPECT_TRUE(after(tracker, {updating(1)}).empty());
    for (int i = 0; i < 5; ++i) {
        const auto barriers = after(tracker, {updating(1)});
        ASSERT_EQ(barriers.size(), 1u);
        EXPECT_EQ(barriers[0].source_access, k_write);
        EXPECT_EQ(barriers[0].target_access, k_read | k_write);
    }
}

TEST(Hazards, OneBufferBoundTwiceInOneCommandIsReadAndWritten) {
    HazardTracker tracker;
    EXPECT_TRUE(after(tracker, {reading(1), writing(1)}).empty());
    const auto barriers = after(tracker, {reading(1)});
    ASSERT_EQ(barriers.size(), 1u);
    EXPECT_EQ(barriers[0].source_access, k_write);
}

// Two barriers that make a write visible, one to loads of vertex shaders and one to texel fetches of compute shaders,
// leave it invisible to loads of compute shaders.
TEST(Hazards, VisibilityIsNotMixedFromTwoBarriers) {
    constexpr VkPipelineStageFlags2 k_vertex = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT;
    HazardTracker tracker;
    after(tracker, {writing(1)});
    EXPECT_EQ(after(tracker, {{.buffer = buffer(1), .stage = k_vertex, .reads = k_read}}).size(), 1u);
    EXPECT_EQ(after(tracker, {{.buffer = buffer(1), .stage = k_compute, .reads = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT}})
                  .size(),
              1u);
    EXPECT_EQ(after(tracker, {reading(1)}).size(), 1u);
    EXPECT_TRUE(after(tracker, {reading(1)}).empty());
}

struct Command {
    Access access;
    std::vector<Barrier> barriers;  // recorded before it
};

// Whether a barrier of the buffer between two commands orders the second behind the first: for a first that writes, its
// writes are made available, and visible to the second.
bool ordered(std::span<const Command> commands, std::size_t first, std::size_t second) {
    const Access &a = commands[first].access, &b = commands[second].access;
    for (std::size_t i = first + 1; i <= second; ++i)
        for (const Barrier& barrier : commands[i].barriers) {
            const VkAccessFlags2 needed = a.writes ? b.reads | b.writes : 0;
            if (barrier.buffer == a.buffer && (barrier.source_stage & a.stage) == a.stage &&
                (barrier.source_access & a.writes) == a.writes && (barrier.target_stage & b.stage) == b.stage &&
                (barrier.target_access & needed) == needed)
                return true;
        }
    return false;
}

// In any sequence each access is ordered behind the last write and, if it writes, behind all reads since then; what
// lies before is ordered through that write. No command has a barrier that none of these pairs needs.
TEST(Hazards, RandomSequencesAreOrdered) {
    constexpr VkAccessFlags2 k_copy_read = VK_ACCESS_2_TRANSFER_READ_BIT, k_copy_write = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    const std::vector<Access> kinds = {
        {.stage = k_compute, .reads = k_read},
        {.stage = k_compute, .reads = VK_ACCESS_2_SHADER_SAMPLED_READ_BIT},
        {.stage = k_compute, .writes = k_write},
        {.stage = k_compute, .reads = k_read, .writes = k_write},
        {.stage = k_transfer, .reads = k_copy_read},
        {.stage = k_transfer, .writes = k_copy_write},
        {.stage = VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, .reads = k_read},
    };
    Random random(1);
    for (int round = 0; round < 300; ++round) {
        HazardTracker tracker;
        std::vector<Command> commands;
        for (std::size_t j = 0; j < 25; ++j) {
            Access access = kinds[random.index(kinds.size())];
            access.buffer = buffer(1 + random.index(2));
            commands.push_back({access, after(tracker, {access})});
            bool hazard = false;
            for (std::size_t i = j; i-- > 0;) {
                const Access& earlier = commands[i].access;
                if (earlier.buffer != access.buffer) continue;
                if (earlier.writes || access.writes) {
                    hazard = true;
                    ASSERT_TRUE(ordered(commands, i, j)) << "round " << round << ", commands " << i << " and " << j;
                }
                if (earlier.writes) break;
            }
            ASSERT_TRUE(hazard || commands[j].barriers.empty()) << "round " << round << ", command " << j;
        }
    }
}

TEST(Hazards, ResetForgets) {
    HazardTracker tracker;
    after(tracker, {writing(1)});
    tracker.reset();
    EXPECT_TRUE(after(tracker, {updating(1)}).empty());
}

}  // namespace
}  // namespace exemplar
