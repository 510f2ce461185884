// Exemplar on a device that is not its own: adopted devices, borrowed buffers, the caller's command buffers and
// semaphores, shared memory. The caller here is a few lines of plain Vulkan.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <mutex>
#include <numeric>
#include <optional>
#include <vector>

#include "embedded/tests_affine_comp.h"
#include "gpu/runtime/record/shared_memory.h"
#include "gpu/runtime/record/stream.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "shaders/shared/test_kernels.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using shared::AffineParameters;
using test_support::shared_device;
using ::testing::HasSubstr;

Kernel affine_on(Device& device) {
    return Kernel(device, shaders::tests_affine_comp,
                  {.push_constants = layout_of<AffineParameters>(), .elements = {layout_of<float>()}});
}

// A device as a program of somebody else opens it, on the physical device that the tests use.
class ForeignDevice {
  public:
    explicit ForeignDevice(bool timeline = true) {
        existing_.instance = shared_device().instance();
        existing_.physical = shared_device().physical();
        existing_.queue_family = shared_device().queue_family();
        existing_.queue_mutex = &mutex_;
        auto& features12 = existing_.features12;
        auto& features13 = existing_.features13;
        features12 = empty_structure<VkPhysicalDeviceVulkan12Features>(
            VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, &features13);
        features13 =
            empty_structure<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
        require_features(features12, features13);
        if (!timeline) features12.timelineSemaphore = VK_FALSE;
        const float priority = 1;
        auto queue = empty_structure<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
        queue.queueFamilyIndex = existing_.queue_family;
        queue.queueCount = 1;
        queue.pQueuePriorities = &priority;
        auto info = empty_structure<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features12);
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queue;
        check(vkCreateDevice(existing_.physical, &info, nullptr, &existing_.device), "open a device");
        vkGetDeviceQueue(existing_.device, existing_.queue_family, 0, &existing_.queue);
    }
    ~ForeignDevice() {
        commands_.reset();
        vkDestroyDevice(existing_.device, nullptr);
    }
    ForeignDevice(const ForeignDevice&) = delete;
    ForeignDevice& operator=(const ForeignDevice&) = delete;

    const ExistingDevice& existing() const { return existing_; }
    VkDevice handle() const { return existing_.device; }

    VkCommandBuffer begin() {
        commands_.emplace(existing_.device);
        auto pool = empty_structure<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
        pool.queueFamilyIndex = existing_.queue_family;
        check(vkCreateCommandPool(existing_.device, &pool, nullptr, commands_->put()), "make a command pool");
        auto allocate = empty_structure<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
        allocate.commandPool = commands_->get();
        allocate.commandBufferCount = 1;
        VkCommandBuffer buffer = VK_NULL_HANDLE;
        check(vkAllocateCommandBuffers(existing_.device, &allocate, &buffer), "make a command buffer");
        const auto begin = empty_structure<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
        check(vkBeginCommandBuffer(buffer, &begin), "record");
        return buffer;
    }
    void run(VkCommandBuffer buffer) {
        check(vkEndCommandBuffer(buffer), "record");
        auto commands = empty_structure<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
        commands.commandBuffer = buffer;
        auto info = empty_structure<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
        info.commandBufferInfoCount = 1;
        info.pCommandBufferInfos = &commands;
        const std::lock_guard lock(mutex_);
        check(vkQueueSubmit2(existing_.queue, 1, &info, VK_NULL_HANDLE), "submit");
        check(vkDeviceWaitIdle(existing_.device), "wait");
    }

  private:
    ExistingDevice existing_;
    std::mutex mutex_;
    std::optional<UniqueCommandPool> commands_;
};

TEST(Embedding, AnAdoptedDeviceWorksAndStaysOpen) {
    ForeignDevice foreign;
    for (int round = 0; round < 2; ++round) {
        Device device(foreign.existing());
        EXPECT_EQ(device.handle(), foreign.handle());
        EXPECT_EQ(device.info().name, shared_device().info().name);
        std::vector<float> values{1, 2, 3};
        const Kernel kernel = affine_on(device);
        const Buffer buffer = Buffer::of<float>(device, values);
        Stream stream(device);
        stream.dispatch(kernel, 3, {buffer}, AffineParameters{3, 2, 1});
        stream.fetch<float>(buffer, values);
        EXPECT_THAT(values, ::testing::ElementsAre(3, 5, 7));
    }
}

TEST(Embedding, AMissingFeatureIsNamed) {
    const ForeignDevice foreign(false);
    try {
        Device device(foreign.existing());
        ADD_FAILURE() << "a device without timeline semaphores was adopted";
    } catch (const NoDeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("timelineSemaphore"));
    }
}

// The caller fills its buffer, Exemplar computes with it, and the caller copies the result, all in one command buffer.
TEST(Embedding, RecordsIntoTheCallersCommands) {
    ForeignDevice foreign;
    Device device(foreign.existing());
    const Kernel kernel = affine_on(device);
    Buffer owned(device, 400), copied(device, 400);  // these stand for buffers of the caller
    const Buffer borrowed = Buffer::borrow(device, owned.handle(), 400);
    for (const std::size_t odd : {0u, 4u, 399u})
        EXPECT_THROW(Buffer::borrow(device, owned.handle(), odd), DeviceError) << odd;
    Stream stream(device);
    std::vector<float> before(100, -1.0f), after(100);
    for (int round = 0; round < 3; ++round) {  // sets and staging memory are used again
        const VkCommandBuffer commands = foreign.begin();
        vkCmdFillBuffer(commands, owned.handle(), 0, VK_WHOLE_SIZE, 0);
        stream.record_into(commands);
        stream.download<float>(borrowed, before);
        stream.dispatch(kernel, 100, {borrowed}, AffineParameters{100, 1, 4});
        EXPECT_THROW(stream.dispatch(kernel, 100, {borrowed, borrowed}, AffineParameters{100, 1, 1}), ShaderError);
        stream.dispatch(kernel, 100, {borrowed}, AffineParameters{100, 2, 1});
        stream.end_recording();
        EXPECT_THROW(stream.fill(borrowed, 0), DeviceError);
        EXPECT_THROW(stream.submit(), DeviceError);
        const VkBufferCopy region{0, 0, 400};
        vkCmdCopyBuffer(commands, owned.handle(), copied.handle(), 1, &region);
        foreign.run(commands);
        stream.retire();
        copied.download<float>(after);
        EXPECT_THAT(before, ::testing::Each(0.0f));
        EXPECT_THAT(after, ::testing::Each(9.0f));
    }
}

TEST(Embedding, CommandsMayBeDropped) {
    ForeignDevice foreign;
    Device device(foreign.existing());
    Buffer buffer(device, 64);
    Stream stream(device);
    EXPECT_THROW(stream.end_recording(), DeviceError);
    const VkCommandBuffer commands = foreign.begin();
    stream.record_into(commands);
    EXPECT_THROW(stream.record_into(commands), DeviceError);
    stream.fill(buffer, 1);
    stream.end_recording();
    stream.retire();
    stream.fill(buffer, 2);  // the stream's own commands again
    stream.finish();
    std::vector<std::uint32_t> words(16);
    buffer.download<std::uint32_t>(words);
    EXPECT_THAT(words, ::testing::Each(2u));
}

TEST(Embedding, WaitsForAndSignalsTimelinesOfTheCaller) {
    Device& device = shared_device();
    auto type = empty_structure<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    const auto info = empty_structure<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type);
    UniqueSemaphore timeline(device.handle());
    check(vkCreateSemaphore(device.handle(), &info, nullptr, timeline.put()), "make a semaphore");
    Buffer buffer(device, 64);
    Stream first(device), second(device);
    first.fill(buffer, 7);
    const Ticket before = first.submit({.signal = timeline.get(), .signal_value = 5});
    second.fill(buffer, 8);
    const Ticket after =
        second.submit({.wait = timeline.get(), .signal = timeline.get(), .wait_value = 5, .signal_value = 6});
    EXPECT_LT(before, after);
    const VkSemaphore handle = timeline.get();
    const std::uint64_t wanted = 6;
    auto wait = empty_structure<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    wait.semaphoreCount = 1;
    wait.pSemaphores = &handle;
    wait.pValues = &wanted;
    EXPECT_EQ(vkWaitSemaphores(device.handle(), &wait, UINT64_MAX), VK_SUCCESS);
    first.wait();
    second.wait();
    std::vector<std::uint32_t> words(16);
    buffer.download<std::uint32_t>(words);
    EXPECT_THAT(words, ::testing::Each(8u));
    // Mesa's queue thread (22.3) still looks at a semaphore that a submission waited for after that submission has
    // signaled: destroyed before, it leaves a damaged heap to the next test.
    device.wait_idle();
}

// What one device writes into shared memory, another reads.
TEST(Embedding, SharesMemoryBetweenDevices) {
    Device& device = shared_device();
    std::optional<SharedBuffer> mine;
    try {
        mine.emplace(device, 4000);
    } catch (const DeviceError& error) {
        GTEST_SKIP() << error.what();
    }
    Device other({.name = std::to_string(device.info().index)});
    const int descriptor = mine->descriptor();
    ASSERT_GE(descriptor, 0);
    SharedBuffer theirs(other, 4000, mine->memory_bytes(), descriptor);
    std::vector<float> values(1000), got(1000);
    std::iota(values.begin(), values.end(), 0.0f);
    Stream writes(device);
    writes.copy(Buffer::of<float>(device, values), 0, mine->buffer(), 0, 4000);
    writes.finish();
    const Kernel kernel = affine_on(other);
    Stream reads(other);
    reads.dispatch(kernel, 1000, {theirs.buffer()}, AffineParameters{1000, 1, 1});
    reads.fetch<float>(theirs.buffer(), got);
    for (std::size_t i = 0; i < got.size(); ++i) ASSERT_EQ(got[i], values[i] + 1);
    EXPECT_THROW(SharedBuffer(other, 1 << 20, mine->memory_bytes(), descriptor), DeviceError);
}

TEST(Embedding, SharesSemaphoresWhereTheDeviceCan) {
    Device& device = shared_device();
    std::optional<SharedSemaphore> semaphore;
    try {
        semaphore.emplace(device);
    } catch (const DeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("VK_KHR_external_semaphore_fd"));
        GTEST_SKIP() << error.what();
    }
    const int descriptor = semaphore->descriptor();
    EXPECT_GE(descriptor, 0);
    close(descriptor);
    Stream signals(device), waits(device);
    signals.submit({.signal = semaphore->handle()});
    waits.submit({.wait = semaphore->handle()});
    waits.wait();
    signals.wait();
}

}  // namespace
}  // namespace exemplar
