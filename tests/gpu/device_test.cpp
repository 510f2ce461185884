#include "gpu/runtime/device/device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "embedded/tests_affine_comp.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"
#include "host/core/files.h"
#include "shaders/shared/test_kernels.h"
#include "tests/gpu/support/environment.h"

namespace exemplar {
namespace {

using test_support::shared_device;
using ::testing::AllOf;
using ::testing::HasSubstr;

// The message of the NoDeviceError that the call throws; empty if it throws none.
template <typename Call>
std::string no_device_message(Call&& call) {
    try {
        call();
    } catch (const NoDeviceError& error) {
        return error.what();
    }
    return {};
}

std::vector<DeviceInfo> three_devices() {
    std::vector<DeviceInfo> devices(3);
    for (std::size_t i = 0; i < devices.size(); ++i) devices[i].index = i;
    devices[0].name = "llvmpipe (LLVM 15.0.6, 256 bits)";
    devices[0].type = DeviceType::cpu;
    devices[1].name = "Intel(R) UHD Graphics";
    devices[1].type = DeviceType::integrated;
    devices[2].name = "NVIDIA H200";
    devices[2].type = DeviceType::discrete;
    return devices;
}

TEST(DeviceSelection, TakesTheBestUnlessNamed) {
    std::vector<DeviceInfo> devices = three_devices();
    EXPECT_EQ(select_device(devices, ""), 2u);
    EXPECT_EQ(select_device(devices, "1"), 1u);
    EXPECT_EQ(select_device(devices, "LLVMpipe"), 0u);
    EXPECT_EQ(select_device(devices, "h200"), 2u);
    EXPECT_EQ(select_device(devices, "200"), 2u);  // no index: a part of a name
    devices[2].unusable = "Vulkan 1.1.0 is older than 1.3";
    EXPECT_EQ(select_device(devices, ""), 1u);
    EXPECT_THAT(no_device_message([&] { select_device(devices, "nvidia"); }), HasSubstr("older than 1.3"));
}

TEST(DeviceSelection, AmongSeveralTheBest) {
    std::vector<DeviceInfo> devices = three_devices();
    devices.push_back(devices[2]);
    devices[3].index = 3;
    devices[2].memory = std::uint64_t{80} << 30;
    devices[3].memory = std::uint64_t{139} << 30;
    EXPECT_EQ(select_device(devices, ""), 3u);
    EXPECT_EQ(select_device(devices, "nvidia"), 3u);
    EXPECT_EQ(select_device(devices, "2"), 2u);
    devices[3].unusable = "it lacks synchronization2";
    EXPECT_EQ(select_device(devices, "nvidia"), 2u);
}

TEST(DeviceSelection, LavapipeBeforeOtherCpuDrivers) {
    std::vector<DeviceInfo> devices = three_devices();
    devices.resize(2);
    std::swap(devices[0].name, devices[1].name);
    devices[0].name = "SwiftShader Device (Subzero)";
    devices[0].memory = std::uint64_t{1} << 40;
    devices[1].type = DeviceType::cpu;
    EXPECT_EQ(select_device(devices, ""), 1u);
    EXPECT_EQ(select_device(devices, "swift"), 0u);
}

TEST(DeviceSelection, WrongNameListsDevicesAndSuggestsTheNearest) {
    const std::vector<DeviceInfo> devices = three_devices();
    EXPECT_THAT(no_device_message([&] { select_device(devices, "nvidai"); }),
                AllOf(HasSubstr("'nvidai'"), HasSubstr("did you mean 'nvidia'"), HasSubstr("NVIDIA H200"),
                      HasSubstr("llvmpipe")));
    EXPECT_THAT(no_device_message([&] { select_device(devices, "3"); }), HasSubstr("NVIDIA H200"));
    EXPECT_THAT(no_device_message([&] { select_device({}, ""); }), HasSubstr("no Vulkan device"));
}

TEST(Device, WrongNameIsAnError) {
    const std::string message = no_device_message([] { Device device({.name = "no-such-device"}); });
    EXPECT_THAT(message, AllOf(HasSubstr("no-such-device"), HasSubstr(shared_device().info().name)));
}

TEST(Device, ReportsWhatItIs) {
    const DeviceInfo& info = shared_device().info();
    EXPECT_FALSE(info.name.empty());
    EXPECT_GE(info.max_storage_range, std::uint64_t{1} << 27);  // Vulkan's own minimum
    EXPECT_GE(info.max_invocations, 128u);
    EXPECT_GT(info.memory, 0u);
    const nlohmann::ordered_json json = to_json({.info = info, .ceilings = Ceilings{1.5, 2.5}});
    EXPECT_EQ(json["name"], info.name);
    EXPECT_EQ(json["copy_gb_per_s"], 1.5);
    EXPECT_EQ(json["usable"], true);
}

TEST(Device, MeasuresItsCeilings) {
    const Ceilings ceilings = measure_ceilings(shared_device());
    EXPECT_GT(ceilings.copy_gb_per_s, 0.01);
    EXPECT_LT(ceilings.copy_gb_per_s, 1e5);
    EXPECT_GT(ceilings.fma_gflop_per_s, 0.01);
    EXPECT_LT(ceilings.fma_gflop_per_s, 1e7);
    EXPECT_GT(ceilings.shared_gb_per_s, 0.01);
    EXPECT_GT(ceilings.texel_gb_per_s, 0.01);
    EXPECT_GT(ceilings.atomic_gop_per_s, 1e-4);
    EXPECT_EQ(ceilings.launch_us > 0, shared_device().info().timestamp_period > 0);
}

TEST(Buffer, OverTheLimitNamesSizeAndLimit) {
    const std::uint64_t limit = shared_device().info().max_allocation;
    try {
        Buffer buffer(shared_device(), limit + 1);
        FAIL() << "no error";
    } catch (const DeviceLimitError& error) {
        EXPECT_EQ(error.requested, limit + 1);
        EXPECT_EQ(error.limit, limit);
        EXPECT_THAT(error.what(), AllOf(HasSubstr(format_bytes(limit)), HasSubstr(shared_device().info().name)));
    }
}

TEST(Buffer, RoundTripsAtOffsets) {
    Buffer buffer(shared_device(), 10 * sizeof(int));
    buffer.upload<int>(std::vector{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    buffer.upload<int>(std::vector{-1, -2}, 3 * sizeof(int));
    std::vector<int> values(4);
    buffer.download<int>(values, 2 * sizeof(int));
    EXPECT_THAT(values, ::testing::ElementsAre(2, -1, -2, 5));
    EXPECT_THROW(buffer.download<int>(values, 7 * sizeof(int)), DeviceError);
    EXPECT_THROW(buffer.upload<int>(values, 7 * sizeof(int)), DeviceError);
    Buffer empty(shared_device(), 0);
    EXPECT_EQ(empty.bytes(), 0u);
    empty.upload<int>(std::span<const int>());
}

// Leaked objects are reported when their device ends.
TEST(Validation, TheLogOutlivesTheDevice) {
    if (!shared_device().switches().validates) GTEST_SKIP() << "EXEMPLAR_VALIDATION is not set; tests/run.sh sets it";
    auto device = std::make_unique<Device>(DeviceOptions{.name = std::to_string(shared_device().info().index)});
    const auto log = device->validation_log();
    const auto info = empty_structure<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    VkSemaphore semaphore = VK_NULL_HANDLE;
    ASSERT_EQ(vkCreateSemaphore(device->handle(), &info, nullptr, &semaphore), VK_SUCCESS);
    EXPECT_TRUE(log->messages().empty());
    device.reset();
    EXPECT_FALSE(log->messages().empty());
}

// The messages a test provokes belong to a device of its own.
TEST(Validation, CollectsWhatTheLayerSays) {
    if (!shared_device().switches().validates) GTEST_SKIP() << "EXEMPLAR_VALIDATION is not set; tests/run.sh sets it";
    Device device({.name = std::to_string(shared_device().info().index)});
    EXPECT_TRUE(device.validation_messages().empty());
    VkBufferCreateInfo info = empty_structure<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;  // with a size of zero, which Vulkan forbids
    VkBuffer buffer = VK_NULL_HANDLE;
    vkCreateBuffer(device.handle(), &info, nullptr, &buffer);
    EXPECT_FALSE(device.validation_messages().empty());
    vkDestroyBuffer(device.handle(), buffer, nullptr);
}

class PipelineCacheTest : public ::testing::Test {
  protected:
    void SetUp() override {
        shared_device();  // keeps its own cache elsewhere
        if (const char* old = std::getenv("XDG_CACHE_HOME")) old_ = old;
        folder_ = std::filesystem::temp_directory_path() / ("exemplar-cache-test-" + std::to_string(getpid()));
        setenv("XDG_CACHE_HOME", folder_.c_str(), 1);
    }
    void TearDown() override {
        if (old_)
            setenv("XDG_CACHE_HOME", old_->c_str(), 1);
        else
            unsetenv("XDG_CACHE_HOME");
        std::filesystem::remove_all(folder_);
    }
    // Opens a device, compiles a kernel and returns how much of a cache file it could use.
    static std::size_t run() {
        auto device = std::make_unique<Device>(DeviceOptions{.name = std::to_string(shared_device().info().index)});
        const auto log = device->validation_log();
        std::optional<Kernel> kernel(std::in_place, *device, shaders::tests_affine_comp,
                                     KernelInterface{.push_constants = layout_of<shared::AffineParameters>()});
        kernel.reset();
        const std::size_t loaded = device->pipeline_cache().loaded_bytes();
        device.reset();
        EXPECT_THAT(log->messages(), ::testing::IsEmpty());
        return loaded;
    }
    std::filesystem::path folder_;
    std::optional<std::string> old_;
};

TEST_F(PipelineCacheTest, IsKeptBetweenRuns) {
    EXPECT_EQ(run(), 0u);
    const std::filesystem::path path = pipeline_cache_path(shared_device().info());
    EXPECT_EQ(path.parent_path(), folder_ / "exemplar");
    ASSERT_TRUE(std::filesystem::exists(path));
    EXPECT_GT(run(), 0u);
}

TEST_F(PipelineCacheTest, DamagedFilesAreIgnoredAndReplaced) {
    run();
    const std::filesystem::path path = pipeline_cache_path(shared_device().info());
    const std::string good = read_file(path);
    std::string flipped = good;
    flipped.back() = static_cast<char>(flipped.back() ^ 1);
    for (const std::string& bad :
         {std::string(), std::string("short"), good.substr(0, good.size() - 1), flipped, good + "x"}) {
        std::ofstream(path, std::ios::binary) << bad;
        EXPECT_EQ(run(), 0u) << bad.size() << " bytes";
        EXPECT_GT(run(), 0u) << "the file was not replaced";
    }
}

TEST_F(PipelineCacheTest, AFolderThatCannotBeWrittenDoesNoHarm) {
    std::ofstream(folder_) << "a file where the folder should be";
    EXPECT_EQ(run(), 0u);
}

// The window system says which queues present; here none does, and one that needs what no driver has.
TEST(Presentation, DevicesThatCannotPresentSaySo) {
    const PresentationOptions never{.instance_extensions = {},
                                    .can_present = [](VkInstance, VkPhysicalDevice, std::uint32_t) { return false; }};
    const PresentationOptions unknown{.instance_extensions = {"VK_EXEMPLAR_no_such_thing"}, .can_present = {}};
    const auto message = [](const PresentationOptions& presentation) -> std::string {
        try {
            const Device device({.presentation = presentation});
        } catch (const DeviceError& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_THAT(message(never), AllOf(HasSubstr(shared_device().info().name), HasSubstr("--device")));
    EXPECT_THAT(message(unknown), HasSubstr("VK_EXEMPLAR_no_such_thing"));
}

}  // namespace
}  // namespace exemplar
