#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Something that was looked at in a machine's Vulkan set-up.
struct Finding {
    enum class Level {
        good,
        remark,  ///< works, but could be better, or matters to some
        fault    ///< nothing can run on a device until it is mended
    };
    Level level = Level::good;
    std::string what;
    std::string mend{};  ///< what to do; empty if there is nothing to mend
};

/// The machine as it is looked at; tests make up others.
struct MachineView {
    std::filesystem::path root = "/";
    std::function<std::string(const char* name)> environment;  ///< the value of a variable; empty if it is not set
};
MachineView this_machine();

/// Whether there is a Vulkan loader.
std::vector<Finding> check_loader();

/// The drivers that are announced to the loader (ICD files), or that the environment names in their place: whether
/// their files can be read and their libraries loaded.
std::vector<Finding> check_drivers(const MachineView& machine);

/// Whether there is graphics hardware that no usable device is of, and whether its device files may be opened.
std::vector<Finding> check_hardware(const MachineView& machine, std::span<const DeviceInfo> devices);

/// The devices, which of them is chosen for `wanted` (see select_device), and what is missing on the others.
std::vector<Finding> check_devices(std::span<const DeviceInfo> devices, const std::string& wanted);

/// What is kept for a device between runs: whether it can be written and read.
std::vector<Finding> check_cache(const DeviceInfo& device);

/// Whether the validation layer is there; a fault if the environment asks for it.
std::vector<Finding> check_validation(const MachineView& machine);

}  // namespace exemplar
