// exemplar doctor: what is wrong with a machine's Vulkan set-up, and how to mend it.

#include <fmt/format.h>

#include <algorithm>

#include "apps/bench/kernels/operation.h"
#include "apps/exemplar/commands.h"
#include "gpu/runtime/measure/setup_check.h"
#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {
namespace {

using Level = Finding::Level;

/// Checks that the basic kernels give the same results on the device and on the host.
std::vector<Finding> check_kernels(const std::string& device_name) {
    constexpr std::size_t k_items = 1000;
    std::vector<Finding> findings;
    Device device({.name = device_name});
    for (const OperationKind& kind : operation_kinds()) {
        if (kind.name != "copying" && kind.name != "stump scoring" && kind.name != "estimated curvature") continue;
        Profiler profiler;
        const Operation operation = kind.prepare(device, profiler, k_items);
        operation.run();
        const std::vector<Difference> differences = operation.differences();
        if (std::ranges::all_of(differences, &Difference::fits))
            findings.push_back({Level::good, fmt::format("{} on '{}' is right", kind.name, device.info().name)});
        else
            findings.push_back({Level::fault, fmt::format("{} on '{}' is wrong", kind.name, device.info().name),
                                "update the driver, or choose another device; 'exemplar bench shaders' tells more"});
    }
    return findings;
}

const char* mark_of(Level level) {
    return level == Level::good ? "ok    " : level == Level::remark ? "note  " : "FAULT ";
}

/// Prints as it finds, as some checks may crash in a broken driver.
class Report {
  public:
    void add(const std::vector<Finding>& findings) {
        for (const Finding& finding : findings) {
            fmt::print("{}{}\n", mark_of(finding.level), finding.what);
            if (!finding.mend.empty() && finding.level != Level::good) fmt::print("      -> {}\n", finding.mend);
            std::fflush(stdout);
            list_.push_back({{"level", finding.level == Level::good     ? "ok"
                                       : finding.level == Level::remark ? "note"
                                                                        : "fault"},
                             {"what", finding.what},
                             {"mend", finding.mend}});
            if (finding.level == Level::fault && fault_.empty()) fault_ = finding.what;
        }
    }
    /// The first fault; empty if there is none.
    const std::string& fault() const { return fault_; }
    const nlohmann::ordered_json& list() const { return list_; }

  private:
    nlohmann::ordered_json list_ = nlohmann::ordered_json::array();
    std::string fault_;
};

void examine(const CommonOptions& options, Report& report) {
    const MachineView machine = this_machine();
    report.add(check_loader());
    report.add(check_drivers(machine));
    if (!report.fault().empty()) return;
    const std::vector<DeviceInfo> devices = list_devices();
    const std::string wanted = options.device.empty() ? machine.environment("EXEMPLAR_DEVICE") : options.device;
    report.add(check_hardware(machine, devices));
    report.add(check_devices(devices, wanted));
    report.add(check_validation(machine));
    if (!report.fault().empty()) return;
    const std::size_t chosen = select_device(devices, wanted);
    report.add(check_cache(devices[chosen]));
    try {
        report.add(check_kernels(std::to_string(devices[chosen].index)));
    } catch (const DeviceError& error) {
        report.add({{Level::fault, error.what(), "update the driver, or choose another device"}});
    }
}

void run_doctor(const CommonOptions& options) {
    const auto limits = apply_common_options(options);
    Report report;
    examine(options, report);
    write_report(options, {{"findings", report.list()}, {"usable", report.fault().empty()}});
    if (!report.fault().empty()) throw NoDeviceError("nothing can run on a device: " + report.fault());
    fmt::print("Exemplar can use this machine.\n");
}

}  // namespace

void add_doctor_command(Command& app) {
    auto options = std::make_shared<CommonOptions>();
    Command* command =
        app.add_subcommand("doctor", "Looks at this machine's Vulkan set-up and says what is wrong and how to mend it");
    command->footer(
        "Loader, drivers, hardware without a driver, rights, devices, what is kept between runs, and whether kernels\n"
        "compute what they should. Exits with 1 if no device can be used.\n\nExample:\n  exemplar doctor");
    add_device_option(*command, *options);
    add_common_options(*command, *options);
    command->callback([options] { run_doctor(*options); });
}

}  // namespace exemplar
