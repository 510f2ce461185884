#include "apps/bench/kernels/measurement.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <span>

#include "apps/bench/kernels/references.h"
#include "apps/bench/kernels/statistics.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"

namespace exemplar {
namespace {

nlohmann::ordered_json statistics_json(const Device& device, const std::string& kernel) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const ExecutableStatistic& statistic : device.statistics_of(kernel)) json[statistic.name] = statistic.value;
    return json;
}

nlohmann::ordered_json kernel_json(const KernelRow& row, const Device& device, const Ceilings& ceilings) {
    const Shares shares = shares_of(row, ceilings);
    nlohmann::ordered_json json = {{"kernel", row.kernel},
                                   {"ms", row.median_milliseconds()},
                                   {"ms_of_repeats", row.milliseconds},
                                   {"relative_error", relative_error(row.milliseconds)},
                                   {"bytes", row.work.bytes},
                                   {"operations", row.work.operations},
                                   {"gb_per_s", row.gb_per_s()},
                                   {"gop_per_s", row.gop_per_s()},
                                   {"share_of_copy", shares.of_copy},
                                   {"share_of_multiply_add", shares.of_multiply_add}};
    if (const auto statistics = statistics_json(device, row.kernel); !statistics.empty())
        json["driver_statistics"] = statistics;
    return json;
}

Measurement read_measurement(const nlohmann::json& json) {
    Measurement measurement;
    json.at("operation").get_to(measurement.operation);
    json.at("items").get_to(measurement.items);
    json.at("size").get_to(measurement.size);
    for (const nlohmann::json& kernel : json.at("kernels"))
        measurement.kernels.push_back({.kernel = kernel.at("kernel"),
                                       .milliseconds = kernel.at("ms_of_repeats"),
                                       .work = {.bytes = kernel.at("bytes"), .operations = kernel.at("operations")}});
    measurement.references = json.at("references_ms").get<KernelTimes>();
    return measurement;
}

struct MeasurementReport {
    std::string device;
    std::vector<Measurement> measurements;
};

MeasurementReport read_report(const std::filesystem::path& path) {
    try {
        const nlohmann::json json = parse_json(read_file(path));
        MeasurementReport report{.device = json.at("device").at("name"), .measurements = {}};
        for (const nlohmann::json& measurement : json.at("measurements"))
            report.measurements.push_back(read_measurement(measurement));
        return report;
    } catch (const nlohmann::json::exception&) {
        throw DataError(fmt::format(
            "{}: this is no report of 'exemplar bench shaders' or 'bench spirv'; make one with --json", path.string()));
    }
}

void compare_and_time(Device& device, const OperationKind& kind, const KernelFilter& filter,
                      const TimingOptions& options, const Ceilings& ceilings, Measurement& measurement) {
    Profiler profiler;
    const Operation operation = kind.prepare(device, profiler, measurement.size);
    operation.run();
    operation.run();
    measurement.differences = operation.differences();
    if (!measurement.fits()) return;
    const References references(device, ceilings);
    std::vector<Timed> timed{{"operation", &operation, &profiler}};
    references.append(timed);
    const std::vector<OperationTimes> times = time_in_turns(timed, options);
    for (auto& [kernel, work] : operation.work())
        if (filter.wants(kind, kernel) && times[0].kernels.contains(kernel))
            measurement.kernels.push_back({kernel, times[0].kernels.at(kernel), work});
    measurement.references = references.times(std::span(times).subspan(1));
}

}  // namespace

double KernelRow::median_milliseconds() const {
    return median(milliseconds);
}
double KernelRow::gb_per_s() const {
    return 1e-6 * work.bytes / median_milliseconds();
}
double KernelRow::gop_per_s() const {
    return 1e-6 * work.operations / median_milliseconds();
}

bool Measurement::fits() const {
    return std::ranges::all_of(differences, &Difference::fits);
}

Shares shares_of(const KernelRow& row, const Ceilings& ceilings) {
    // If a kernel takes hardly longer than a launch, the difference is noise: at least a tenth of its time is kept.
    constexpr double k_least_left = 0.1;
    const double all = row.median_milliseconds(), left = std::max(all - 1e-3 * ceilings.launch_us, k_least_left * all);
    return {row.gb_per_s() / ceilings.copy_gb_per_s * all / left,
            row.gop_per_s() / ceilings.fma_gflop_per_s * all / left};
}

KernelFilter::KernelFilter(const std::string& expression) : expression_(expression) {
    try {
        static_cast<void>(std::regex(expression));
    } catch (const std::regex_error& error) {
        throw UsageError(fmt::format("--filter '{}' is no regular expression: {}", expression, error.what()));
    }
    const auto& kinds = operation_kinds();
    if (std::ranges::none_of(kinds, [&](const OperationKind& kind) { return wants(kind); }))
        throw UsageError(fmt::format(
            "--filter '{}' finds no kernel; 'exemplar bench shaders --list' shows all with their operations",
            expression));
}

bool KernelFilter::wants(const OperationKind& kind) const {
    return std::ranges::any_of(kind.kernels, [&](const Shader* kernel) { return wants(kind, kernel->name); });
}

bool KernelFilter::wants(const OperationKind& kind, std::string_view kernel) const {
    const std::regex wanted(expression_);
    return std::regex_search(kernel.begin(), kernel.end(), wanted) ||
           std::regex_search(kind.name.begin(), kind.name.end(), wanted);
}

Measurement measure_operation(Device& device, const OperationKind& kind, std::size_t size, const KernelFilter& filter,
                              const TimingOptions& options, const Ceilings& ceilings) {
    Measurement measurement;
    measurement.operation = kind.name;
    measurement.items = kind.items;
    measurement.size = size;
    try {
        compare_and_time(device, kind, filter, options, ceilings, measurement);
    } catch (const DeviceLimitError& error) {
        measurement.refused = error.what();
    }
    return measurement;
}

nlohmann::ordered_json to_json(const Measurement& measurement, const Device& device, const Ceilings& ceilings) {
    nlohmann::ordered_json json = {
        {"operation", measurement.operation}, {"items", measurement.items}, {"size", measurement.size}};
    if (!measurement.refused.empty()) json["refused"] = measurement.refused;
    json["differences"] = nlohmann::ordered_json::array();
    for (const Difference& difference : measurement.differences)
        json["differences"].push_back(
            {{"of", difference.of}, {"largest", difference.largest}, {"tolerance", difference.tolerance}});
    json["kernels"] = nlohmann::ordered_json::array();
    for (const KernelRow& row : measurement.kernels) json["kernels"].push_back(kernel_json(row, device, ceilings));
    json["references_ms"] = measurement.references;
    return json;
}

std::vector<Measurement> read_measurements(const std::filesystem::path& path, const DeviceInfo& device) {
    MeasurementReport report = read_report(path);
    if (report.device != device.name)
        throw UsageError(fmt::format("{}: it was measured on device '{}', this is '{}'; compare the same device",
                                     path.string(), report.device, device.name));
    return std::move(report.measurements);
}

ReportedTimes read_times(const std::filesystem::path& path) {
    const MeasurementReport report = read_report(path);
    ReportedTimes times{.device = report.device, .milliseconds = {}};
    for (const Measurement& measurement : report.measurements)
        for (const KernelRow& row : measurement.kernels) {
            double& longest = times.milliseconds[row.kernel];
            longest = std::max(longest, row.median_milliseconds());
        }
    return times;
}

}  // namespace exemplar
