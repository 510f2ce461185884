// exemplar devices: the Vulkan devices of this machine, their limits and their measured speeds.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

#include "apps/exemplar/commands.h"
#include "gpu/runtime/device/device_info.h"
#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {
namespace {

struct DevicesOptions {
    CommonOptions common;
    bool no_measure = false;
};

constexpr std::size_t k_device_columns = 12;
using DeviceRow = std::array<std::string, k_device_columns>;

const DeviceRow k_header{"",       "#",           "name",      "type",     "driver",     "Vulkan",
                         "memory", "max storage", "workgroup", "subgroup", "copy, GB/s", "FMA, GFLOP/s"};
constexpr std::size_t k_first_number = 6;  // from here on columns are aligned to the right

std::string wanted_device(const DevicesOptions& options) {
    if (!options.common.device.empty()) return options.common.device;
    const char* value = std::getenv("EXEMPLAR_DEVICE");
    return value ? value : "";
}

// One device's report; what kept it from being measured goes into `remarks`.
DeviceReport make_report(const DeviceInfo& info, const DevicesOptions& options, std::vector<std::string>& remarks) {
    if (!info.unusable.empty()) {
        remarks.push_back(fmt::format("{} cannot be used: {}", info.name, info.unusable));
    } else if (!options.no_measure) {
        try {
            return report_device(info.index);
        } catch (const DeviceError& error) {
            remarks.push_back(fmt::format("{} cannot be measured: {}", info.name, error.what()));
        }
    }
    return {.info = info};
}

DeviceRow table_row(const DeviceReport& report, bool chosen) {
    const DeviceInfo& info = report.info;
    const auto rate = [&](double Ceilings::*member) {
        return report.ceilings ? fmt::format("{:.1f}", *report.ceilings.*member) : "-";
    };
    return {chosen ? "*" : "",
            std::to_string(info.index),
            info.name,
            std::string(to_string(info.type)),
            fmt::format("{} {}", info.driver_name, info.driver_version),
            info.api_version,
            format_bytes(info.memory),
            format_bytes(info.max_storage_range),
            std::to_string(info.max_invocations),
            std::to_string(info.subgroup_size),
            rate(&Ceilings::copy_gb_per_s),
            rate(&Ceilings::fma_gflop_per_s)};
}

void print_table(const std::vector<DeviceRow>& rows) {
    std::array<std::size_t, k_device_columns> widths{};
    for (const DeviceRow& row : rows)
        for (std::size_t c = 0; c < k_device_columns; ++c) widths[c] = std::max(widths[c], row[c].size());
    for (const DeviceRow& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < k_device_columns; ++c)
            line += c < k_first_number ? fmt::format("{:<{}}  ", row[c], widths[c])
                                       : fmt::format("{:>{}}  ", row[c], widths[c]);
        fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

void run_devices(const DevicesOptions& options) {
    const auto limits = apply_common_options(options.common);
    std::vector<DeviceInfo> devices = list_devices();
    // If no device can be used, the table says why before choosing one throws.
    const bool choice = std::ranges::any_of(devices, [](const DeviceInfo& info) { return info.unusable.empty(); });
    const std::size_t chosen = choice ? select_device(devices, wanted_device(options)) : devices.size();

    std::vector<DeviceRow> rows{k_header};
    std::vector<std::string> remarks;
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    std::ranges::stable_sort(devices, is_better);  // the order in which they would be chosen
    for (const DeviceInfo& info : devices) {
        const DeviceReport report = make_report(info, options, remarks);
        rows.push_back(table_row(report, info.index == chosen));
        list.push_back(to_json(report));
        list.back()["chosen"] = info.index == chosen;
    }
    if (!devices.empty()) print_table(rows);
    if (!options.common.quiet)
        for (const std::string& remark : remarks) fmt::print(stderr, "warning: {}\n", remark);
    write_report(options.common, {{"devices", list}});
    if (!choice) select_device(devices, wanted_device(options));
}

}  // namespace

void add_devices_command(Command& app) {
    auto options = std::make_shared<DevicesOptions>();
    Command* command = app.add_subcommand(
        "devices", "Lists the Vulkan devices (* is the one that would be used), their limits and speeds");
    command->footer(
        "Example:\n  exemplar devices\n  EXEMPLAR_DEVICE=llvmpipe exemplar devices --no-measure --json devices.json");
    command->add_flag("--no-measure", options->no_measure, "skip the speeds, which take about a second per device");
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_devices(*options); });
}

}  // namespace exemplar
