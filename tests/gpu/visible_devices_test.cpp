#include "gpu/runtime/device/visible_devices.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr std::uint32_t k_of_nvidia = 0x10de, k_of_amd = 0x1002;

DeviceInfo card(std::size_t index, std::uint32_t vendor, const std::string& address, std::uint8_t uuid) {
    DeviceInfo info;
    info.index = index;
    info.name = "card";
    info.type = DeviceType::discrete;
    info.vendor = vendor;
    info.pci_address = address;
    info.uuid.fill(uuid);
    return info;
}

// Three cards of NVIDIA, listed by descending PCI address, one of AMD and a CPU.
std::vector<DeviceInfo> a_node() {
    std::vector<DeviceInfo> devices{
        card(0, k_of_nvidia, "0000:c1:00.0", 0xc1), card(1, k_of_nvidia, "0000:81:00.0", 0x81),
        card(2, k_of_nvidia, "0000:41:00.0", 0x41), card(3, k_of_amd, "0000:21:00.0", 0x21)};
    devices.push_back(card(4, 0x10005, "", 0));
    devices.back().type = DeviceType::cpu;
    return devices;
}

// The indices of the devices that stay usable.
std::vector<std::size_t> left_by(const std::map<std::string, std::string>& variables) {
    std::vector<DeviceInfo> devices = a_node();
    hide_devices_of_others(devices, [&](const char* name) {
        const auto found = variables.find(name);
        return found == variables.end() ? nullptr : found->second.c_str();
    });
    std::vector<std::size_t> left;
    for (const DeviceInfo& device : devices)
        if (device.unusable.empty()) left.push_back(device.index);
    return left;
}

TEST(VisibleDevices, WithoutVariablesAllAreVisible) {
    EXPECT_THAT(left_by({}), ElementsAre(0, 1, 2, 3, 4));
}

TEST(VisibleDevices, NumbersFollowThePciAddresses) {
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "0"}}), ElementsAre(2, 3, 4));
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "2,1"}}), ElementsAre(0, 1, 3, 4));
    EXPECT_THAT(left_by({{"ROCR_VISIBLE_DEVICES", "0"}}), ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(left_by({{"ROCR_VISIBLE_DEVICES", ""}, {"CUDA_VISIBLE_DEVICES", ""}}), ElementsAre(4));
}

TEST(VisibleDevices, UuidsMayBeShortened) {
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "GPU-81818181-8181-8181-8181-818181818181"}}), ElementsAre(1, 3, 4));
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "GPU-C1c1"}}), ElementsAre(0, 3, 4));
}

TEST(VisibleDevices, AnEntryThatNamesNoCardEndsTheList) {
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "1,-1,0"}}), ElementsAre(1, 3, 4));
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "1,7,0"}}), ElementsAre(1, 3, 4));
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "GPU-"}}), ElementsAre(3, 4));
}

TEST(VisibleDevices, PartsOfCardsHideNothing) {
    EXPECT_THAT(left_by({{"CUDA_VISIBLE_DEVICES", "MIG-81818181-8181-8181-8181-818181818181"}}),
                ElementsAre(0, 1, 2, 3, 4));
}

// Slurm's numbers count where the program still sees more cards than it was given.
TEST(VisibleDevices, SlurmNumbersTheCardsOfANode) {
    EXPECT_THAT(left_by({{"SLURM_JOB_GPUS", "0,2"}}), ElementsAre(1, 3, 4));
    EXPECT_THAT(left_by({{"SLURM_STEP_GPUS", "1"}, {"SLURM_JOB_GPUS", "0,2"}}), ElementsAre(2, 4));
    EXPECT_THAT(left_by({{"SLURM_JOB_GPUS", "4,5,6,7"}}), ElementsAre(0, 1, 2, 3, 4));
    EXPECT_THAT(left_by({{"SLURM_JOB_GPUS", "0"}, {"CUDA_VISIBLE_DEVICES", "0"}}), ElementsAre(2, 3, 4));
}

TEST(VisibleDevices, ARefusalNamesTheVariable) {
    std::vector<DeviceInfo> devices = a_node();
    hide_devices_of_others(
        devices, [](const char* name) { return std::string(name) == "CUDA_VISIBLE_DEVICES" ? "1" : nullptr; });
    try {
        select_device(devices, "0");
        ADD_FAILURE() << "a hidden card was taken";
    } catch (const NoDeviceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("CUDA_VISIBLE_DEVICES=1"));
    }
}

TEST(DeviceSelection, ByUuidOrPciAddress) {
    const std::vector<DeviceInfo> devices = a_node();
    EXPECT_EQ(select_device(devices, "uuid:41414141-4141-4141-4141-414141414141"), 2u);
    EXPECT_EQ(select_device(devices, "uuid:C1C1"), 0u);
    EXPECT_EQ(select_device(devices, "pci:0000:81:00.0"), 1u);
    EXPECT_EQ(select_device(devices, "pci:21:00.0"), 3u);
    for (const char* wrong : {"uuid:", "uuid:zz", "pci:", "pci:0000:99:00.0", "pci:0001:21:00.0"})
        EXPECT_THROW(select_device(devices, wrong), NoDeviceError) << wrong;
}

}  // namespace
}  // namespace exemplar
