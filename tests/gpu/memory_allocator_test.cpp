#include "gpu/runtime/vulkan/memory_allocator.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "gpu/runtime/record/stream.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using test_support::shared_device;

constexpr std::size_t k_mebibyte = std::size_t{1} << 20;

MemoryPart part_of(MemoryAllocator& allocator, std::size_t bytes, std::size_t alignment = 16,
                   MemoryContent content = MemoryContent::buffer) {
    const std::uint32_t type = shared_device().memory_type(~0u, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
    MemoryPart part;
    check(allocator.allocate({bytes, alignment, ~0u}, type, content, part), "allocate memory");
    return part;
}

struct AllocatorOfItsOwn {
    HostWorkCounter work;
    VkPhysicalDeviceMemoryProperties types{};
    MemoryAllocator allocator;
    AllocatorOfItsOwn()
        : types([] {
              VkPhysicalDeviceMemoryProperties properties{};
              vkGetPhysicalDeviceMemoryProperties(shared_device().physical(), &properties);
              return properties;
          }()),
          allocator(shared_device().handle(), types, work) {}
};

TEST(MemoryAllocator, ManyBuffersTakeFewAllocations) {
    Device& device = shared_device();
    const std::size_t before = device.memory().live_allocations();
    std::mt19937 random(1);
    std::vector<Buffer> buffers;
    buffers.reserve(3000);
    for (int i = 0; i < 3000; ++i) buffers.emplace_back(device, random() % 60'000);
    EXPECT_LE(device.memory().live_allocations(), before + 40);
    buffers.clear();
    EXPECT_LE(device.memory().live_allocations(), before + 1);
}

// Parts that are in use never overlap and keep their alignment, whatever the order of taking and returning.
TEST(MemoryAllocator, PartsAreApartAndAligned) {
    AllocatorOfItsOwn own;
    struct Held {
        MemoryPart part;
        std::size_t bytes;
    };
    std::vector<Held> held;
    std::mt19937 random(7);
    for (int step = 0; step < 4000; ++step) {
        if (!held.empty() && random() % 100 < 45) {
            std::swap(held[random() % held.size()], held.back());
            held.pop_back();
            continue;
        }
        const std::size_t bytes = 1 + random() % (random() % 20 == 0 ? 2 * k_mebibyte : 5000);
        const std::size_t alignment = std::size_t{1} << random() % 13;
        held.push_back({part_of(own.allocator, bytes, alignment), bytes});
        ASSERT_EQ(held.back().part.offset() % alignment, 0u);
    }
    std::ranges::sort(held, {}, [](const Held& h) { return std::pair(h.part.memory(), h.part.offset()); });
    for (std::size_t i = 1; i < held.size(); ++i) {
        const Held &before = held[i - 1], &after = held[i];
        const bool apart =
            before.part.memory() != after.part.memory() || before.part.offset() + before.bytes <= after.part.offset();
        ASSERT_TRUE(apart) << i;
    }
    held.clear();
    EXPECT_EQ(own.allocator.live_allocations(), 1u);  // one empty block is kept
}

TEST(MemoryAllocator, KeepsAnEmptyBlockAndReturnsOthers) {
    AllocatorOfItsOwn own;
    for (int i = 0; i < 10; ++i) part_of(own.allocator, 100);
    EXPECT_EQ(own.work.total()[HostTask::allocation], 1u);
    {
        const MemoryPart large = part_of(own.allocator, 80 * k_mebibyte);
        EXPECT_EQ(own.allocator.live_allocations(), 2u);
    }
    EXPECT_EQ(own.allocator.live_allocations(), 1u);  // not the large one
}

TEST(MemoryAllocator, ImagesAndBuffersHaveBlocksOfTheirOwn) {
    AllocatorOfItsOwn own;
    const MemoryPart buffer = part_of(own.allocator, 100),
                     image = part_of(own.allocator, 100, 16, MemoryContent::image);
    EXPECT_NE(buffer.memory(), image.memory());
}

}  // namespace
}  // namespace exemplar
