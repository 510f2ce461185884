#include "gpu/runtime/hazards.h"

#include <gtest/gtest.h>

#include <cstdint>

// The validation layer does not see a missing barrier between two dispatches of one pipeline on one buffer, so the
// rules are tested here by themselves.
namespace exemplar {
namespace {

constexpr VkPipelineStageFlags2 k_compute = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
constexpr VkPipelineStageFlags2 k_transfer = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
constexpr VkAccessFlags2 k_read = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
constexpr VkAccessFlags2 k_write = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

VkBuffer buffer(std::uintptr_t id) {
    return reinterpret_cast<VkBuffer>(id);
}  // NOLINT: a name, never used as an address

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

TEST(Hazards, ResetForgets) {
    HazardTracker tracker;
    after(tracker, {writing(1)});
    tracker.reset();
    EXPECT_TRUE(after(tracker, {updating(1)}).empty());
}

}  // namespace
}  // namespace exemplar
