#include "gpu/runtime/measure/setup_check.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <unistd.h>
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>

#include "gpu/runtime/device/device_cache.h"
#include "gpu/runtime/device/pipeline_cache.h"
#include "gpu/runtime/device/tuning.h"
#include "gpu/runtime/vulkan/functions.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"

namespace exemplar {
namespace {

using std::filesystem::path;
using Level = Finding::Level;

/// The entries of a folder in order; none if it cannot be read.
std::vector<path> entries_of(const path& folder) {
    std::vector<path> entries;
    std::error_code error;
    for (std::filesystem::directory_iterator at(folder, error), end; !error && at != end; at.increment(error))
        entries.push_back(at->path());
    std::ranges::sort(entries);
    return entries;
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find(separator, begin), text.size());
        if (end > begin) parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

/// The variable that names drivers in place of those installed; the loader knows two names.
const char* driver_variable(const MachineView& machine) {
    for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"})
        if (!machine.environment(name).empty()) return name;
    return nullptr;
}

/// The drivers that a variable names.
std::vector<path> named_drivers(const MachineView& machine, const char* variable) {
    const std::vector<std::string> names = split(machine.environment(variable), ':');
    return {names.begin(), names.end()};
}

std::vector<path> installed_drivers(const MachineView& machine) {
    std::vector<path> files;
    const auto add = [&](const path& folder) {
        for (const path& file : entries_of(folder / "vulkan/icd.d"))
            if (file.extension() == ".json") files.push_back(file);
    };
    for (const char* folder : {"etc", "usr/local/share", "usr/share"}) add(machine.root / folder);
    const std::string own = machine.environment("XDG_DATA_HOME"), home = machine.environment("HOME");
    if (!own.empty())
        add(own);
    else if (!home.empty())
        add(path(home) / ".local/share");
    return files;
}

/// Returns why a library cannot be loaded; empty if it can.
std::string loading_error(const std::string& library) {
    void* const handle = dlopen(library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    if (!handle) return dlerror();
    dlclose(handle);
    return {};
}

/// A driver's file, as the loader reads it.
Finding check_driver(const path& file) {
    std::string library;
    try {
        library = parse_json(read_file(file)).at("ICD").at("library_path");
    } catch (const std::exception&) {
        return {Level::remark, fmt::format("driver {} cannot be read", file.string()),
                "install the package that it belongs to again, or delete it"};
    }
    // A path with a folder is relative to the file; a bare name is left to the system's search.
    if (library.find('/') != std::string::npos && path(library).is_relative())
        library = (file.parent_path() / library).string();
    const std::string error = loading_error(library);
    if (error.empty()) return {Level::good, fmt::format("driver {} ({})", file.stem().string(), library)};
    // Other architectures' drivers lie beside these.
    if (error.find("wrong ELF class") != std::string::npos)
        return {Level::good, fmt::format("driver {} is for programs of another architecture", file.stem().string())};
    return {Level::remark, fmt::format("driver {} cannot be loaded: {}", file.string(), error),
            "install its package again, with the libraries that it needs; or delete the file if the driver is gone"};
}

std::string read_line(const path& file) {
    try {
        std::string text = read_file(file);
        text.erase(std::min(text.find('\n'), text.size()));
        return text;
    } catch (const Error&) {
        return {};
    }
}

struct Vendor {
    const char* pci;
    const char* name;
    const char* mend;
};
constexpr Vendor k_vendors[] = {
    {"0x10de", "NVIDIA",
     "install NVIDIA's driver (on Debian nvidia-driver; in a container, its graphics libraries too)"},
    {"0x1002", "AMD", "install mesa-vulkan-drivers, and the firmware firmware-amd-graphics"},
    {"0x8086", "Intel", "install mesa-vulkan-drivers"}};

/// Makers of the machine's graphics hardware: PCI classes 03xx.
std::vector<const Vendor*> graphics_hardware(const MachineView& machine) {
    std::vector<const Vendor*> found;
    for (const path& device : entries_of(machine.root / "sys/bus/pci/devices")) {
        if (!read_line(device / "class").starts_with("0x03")) continue;
        const std::string vendor = read_line(device / "vendor");
        for (const Vendor& known : k_vendors)
            if (vendor == known.pci && std::ranges::find(found, &known) == found.end()) found.push_back(&known);
    }
    return found;
}

bool is_of(const DeviceInfo& device, const Vendor& vendor) {
    if (device.type == DeviceType::cpu || !device.unusable.empty()) return false;
    const std::string all = device.name + ' ' + device.driver_name;
    return all.find(vendor.name) != std::string::npos ||
           (std::strcmp(vendor.name, "AMD") == 0 && all.find("RADV") != std::string::npos);
}

/// Device files that exist and may not be opened.
std::vector<path> closed_device_files(const MachineView& machine) {
    std::vector<path> closed;
    for (const path& folder : {machine.root / "dev/dri", machine.root / "dev"})
        for (const path& file : entries_of(folder)) {
            const std::string name = file.filename().string();
            const bool graphics = name.starts_with("renderD") || name == "nvidiactl" || name == "nvidia0";
            if (graphics && access(file.c_str(), R_OK | W_OK) != 0) closed.push_back(file);
        }
    return closed;
}

std::string describe(const DeviceInfo& device) {
    return fmt::format("device {}: {} ({}, {} {})", device.index, device.name, to_string(device.type),
                       device.driver_name, device.driver_version);
}

/// Returns why files cannot be written to a folder; empty if they can.
std::string writing_error(const path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) return error.message();
    return access(folder.c_str(), W_OK) == 0 ? std::string() : std::string(std::strerror(errno));
}

}  // namespace

MachineView this_machine() {
    return {.root = "/", .environment = [](const char* name) {
                const char* value = std::getenv(name);
                return std::string(value ? value : "");
            }};
}

std::vector<path> driver_files(const MachineView& machine) {
    std::vector<path> files;
    if (const char* const variable = driver_variable(machine)) files = named_drivers(machine, variable);
    std::ranges::move(installed_drivers(machine), std::back_inserter(files));
    return files;
}

std::vector<Finding> check_loader() {
    if (const std::uint32_t version = vulkan_loader_version()) {
        return {{Level::good, fmt::format("Vulkan loader {}.{}.{}", VK_API_VERSION_MAJOR(version),
                                          VK_API_VERSION_MINOR(version), VK_API_VERSION_PATCH(version))}};
    }
    return {{Level::fault, "there is no Vulkan loader (libvulkan.so.1)",
             "install it: on Debian and Ubuntu libvulkan1, on Fedora vulkan-loader"}};
}

std::vector<Finding> check_drivers(const MachineView& machine) {
    std::vector<Finding> findings;
    const char* const variable = driver_variable(machine);
    std::vector<path> files;
    if (variable) {
        findings.push_back({Level::remark,
                            fmt::format("{} names the drivers to use: {}", variable, machine.environment(variable)),
                            "unset it to use those that are installed"});
        files = named_drivers(machine, variable);
    } else {
        files = installed_drivers(machine);
    }
    for (const path& file : files) {
        std::error_code error;
        if (std::filesystem::exists(file, error))
            findings.push_back(check_driver(file));
        else
            findings.push_back({Level::fault, fmt::format("{} names {}, which does not exist", variable, file.string()),
                                fmt::format("correct or unset {}", variable)});
    }
    if (files.empty())
        findings.push_back({Level::fault, "no Vulkan driver is installed",
                            "install your graphics card's, or mesa-vulkan-drivers, which has one for any CPU"});
    return findings;
}

std::vector<Finding> check_hardware(const MachineView& machine, std::span<const DeviceInfo> devices) {
    std::vector<Finding> findings;
    for (const Vendor* vendor : graphics_hardware(machine)) {
        const bool used = std::ranges::any_of(devices, [&](const DeviceInfo& d) { return is_of(d, *vendor); });
        if (used)
            findings.push_back({Level::good, fmt::format("the graphics hardware of {} has a driver", vendor->name)});
        else
            findings.push_back(
                {Level::remark,
                 fmt::format("there is graphics hardware of {}, but no usable Vulkan device of it", vendor->name),
                 vendor->mend});
    }
    for (const path& file : closed_device_files(machine))
        findings.push_back({Level::remark, fmt::format("you may not open {}", file.string()),
                            "add yourself to the group that it belongs to ('sudo usermod -aG render,video $USER') and "
                            "log in again"});
    return findings;
}

std::vector<Finding> check_devices(std::span<const DeviceInfo> devices, const std::string& wanted) {
    std::vector<Finding> findings;
    std::optional<std::size_t> chosen;
    std::string refused;
    try {
        chosen = select_device(devices, wanted);
    } catch (const DeviceError& error) {
        refused = error.what();
    }
    for (const DeviceInfo& device : devices) {
        if (!device.unusable.empty())
            findings.push_back({Level::remark, fmt::format("{} cannot be used: {}", describe(device), device.unusable),
                                "update its driver"});
        else
            findings.push_back(
                {Level::good, describe(device) + (chosen == device.index ? ", which would be used" : "")});
    }
    if (chosen && devices[*chosen].type == DeviceType::cpu)
        findings.push_back({Level::remark, "the device that would be used is a CPU: everything works, but not as fast",
                            "if there is a graphics card, choose it with --device or EXEMPLAR_DEVICE"});
    if (!chosen)
        findings.push_back(
            {Level::fault, refused,
             wanted.empty() ? "install or update a Vulkan 1.3 driver" : "correct --device or EXEMPLAR_DEVICE"});
    return findings;
}

std::vector<Finding> check_cache(const DeviceInfo& device) {
    const path file = tuning_path(device);
    if (file.empty())
        return {{Level::remark, "neither HOME nor XDG_CACHE_HOME is set: each run compiles all kernels anew",
                 "set one of them"}};
    const path folder = file.parent_path();
    if (const std::string error = writing_error(folder); !error.empty())
        return {{Level::remark,
                 fmt::format("{} cannot be written ({}): each run compiles all kernels anew", folder.string(), error),
                 "make it writable, or set XDG_CACHE_HOME to a folder that is"}};
    try {
        const bool tuned = !Tuning::load(file).empty();
        return {{Level::good, fmt::format("{} keeps compiled kernels{}", folder.string(),
                                          tuned ? " and the fastest variants of some for this device"
                                                : "; 'exemplar bench shaders --tune' may make some faster")}};
    } catch (const Error& error) {
        return {{Level::remark, error.what(), fmt::format("delete {}", file.string())}};
    }
}

std::vector<Finding> check_validation(const MachineView& machine) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    const bool there = std::ranges::any_of(layers, [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, "VK_LAYER_KHRONOS_validation") == 0;
    });
    const std::string asked = machine.environment("EXEMPLAR_VALIDATION");
    if (there) return {{Level::good, "the validation layer is installed (EXEMPLAR_VALIDATION=1 uses it)"}};
    if (asked.empty() || asked == "0")
        return {{Level::good, "no validation layer, which only people who change shaders need"}};
    return {{Level::fault, "EXEMPLAR_VALIDATION asks for the validation layer, which is not installed",
             "install vulkan-validationlayers, or unset EXEMPLAR_VALIDATION"}};
}

}  // namespace exemplar
