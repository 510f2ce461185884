#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "gpu/runtime/device/device_info.h"

namespace exemplar {

/// Result of one check of a machine's Vulkan set-up.
struct Finding {
    enum class Level {
        good,
        remark,  ///< works, but could be better, or matters only to some users
        fault    ///< nothing can run on a device until it is mended
    };
    Level level = Level::good;
    std::string what;
    std::string mend{};  ///< what to do; empty if there is nothing to mend
};

/// The machine that is checked; tests invent others.
struct MachineView {
    std::filesystem::path root = "/";
    std::function<std::string(const char* name)> environment;  ///< the value of a variable; empty if it is not set
};
MachineView this_machine();

/// Returns the files of drivers (ICD files): those that the environment names, then those installed for the loader.
std::vector<std::filesystem::path> driver_files(const MachineView& machine);

/// Checks whether there is a Vulkan loader.
std::vector<Finding> check_loader();

/// Checks whether the files of drivers can be read and their libraries loaded. Drivers are those installed for the
/// loader (ICD files), or those that the environment names instead.
std::vector<Finding> check_drivers(const MachineView& machine);

/// Checks for graphics hardware without a usable device, and whether its device files may be opened.
std::vector<Finding> check_hardware(const MachineView& machine, std::span<const DeviceInfo> devices);

/// Lists the devices, the one chosen for `wanted` (see select_device), and what the others lack.
std::vector<Finding> check_devices(std::span<const DeviceInfo> devices, const std::string& wanted);

/// Checks whether the files kept for a device between runs can be written and read.
std::vector<Finding> check_cache(const DeviceInfo& device);

/// Checks whether the validation layer is installed; a missing one is a fault if the environment asks for it.
std::vector<Finding> check_validation(const MachineView& machine);

}  // namespace exemplar
