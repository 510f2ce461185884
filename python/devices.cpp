// The Vulkan devices of this machine.

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>

#include "gpu/runtime/device/device_info.h"
#include "python/bindings.h"
#include "python/long_work.h"

namespace exemplar::python {
namespace {

namespace py = pybind11;

/// The devices, the one that would be chosen first.
std::vector<DeviceInfo> devices() {
    return long_result([] {
        std::vector<DeviceInfo> found = list_devices();
        std::ranges::stable_sort(found, is_better);
        return found;
    });
}

std::string device_representation(const DeviceInfo& info) {
    return fmt::format("<exemplar.DeviceInfo {}: {} ({}){}>", info.index, info.name, to_string(info.type),
                       info.unusable.empty() ? "" : ", cannot be used");
}

}  // namespace

void add_devices(py::module_& module) {
    py::class_<DeviceInfo>(module, "DeviceInfo", "A Vulkan device, as devices() lists it.")
        .def_readonly("index", &DeviceInfo::index, "Its number: what to give as `device`.")
        .def_readonly("name", &DeviceInfo::name, "Its name: a part of it may be given as `device`, too.")
        .def_property_readonly(
            "type", [](const DeviceInfo& info) { return std::string(to_string(info.type)); },
            "\"discrete GPU\", \"integrated GPU\", \"virtual GPU\", \"CPU\" or \"other\".")
        .def_property_readonly(
            "driver", [](const DeviceInfo& info) { return info.driver_name + " " + info.driver_version; },
            "The driver and its version.")
        .def_readonly("api_version", &DeviceInfo::api_version, "Of Vulkan, as \"1.3.230\".")
        .def_readonly("memory", &DeviceInfo::memory, "Bytes of its largest memory of its own.")
        .def_readonly("unusable", &DeviceInfo::unusable, "Why Exemplar cannot use it; empty if it can.")
        .def("__repr__", &device_representation);
    module.def("devices", &devices,
               "The Vulkan devices of this machine, the best first: what is used where no device is named, unless the\n"
               "environment's EXEMPLAR_DEVICE names another. Empty if there is no Vulkan driver.");
}

}  // namespace exemplar::python
