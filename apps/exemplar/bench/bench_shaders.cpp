// exemplar bench shaders: every kernel compared with its reference, timed on the device, and its variants.

#include <fmt/format.h>

#include <algorithm>

#include "apps/bench/kernels/measurement.h"
#include "apps/bench/kernels/variants.h"
#include "apps/exemplar/arguments.h"
#include "apps/exemplar/bench/bench_kernel_table.h"
#include "apps/exemplar/bench/bench_statistics.h"
#include "apps/exemplar/commands.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

struct ShaderBenchOptions {
    CommonOptions common;
    std::string filter;
    std::filesystem::path baseline;
    std::vector<std::size_t> sizes;
    std::size_t repeats = 7;
    double seconds = 600;
    bool tune = false, list = false, statistics = false, in_this_process = false;
    StatisticsOptions compiling;
};

/// An operation of one size that is to be measured.
struct Task {
    const OperationKind* kind;
    std::size_t size;
};

std::vector<Task> tasks_of(const ShaderBenchOptions& options, const KernelFilter& filter) {
    std::vector<Task> tasks;
    for (const OperationKind& kind : operation_kinds()) {
        if (!filter.wants(kind)) continue;
        // Variants are compared at the middle size, where the cost of dispatching does not matter.
        const std::vector<std::size_t> usual =
            options.tune ? std::vector{kind.sizes[kind.sizes.size() / 2]} : kind.sizes;
        for (const std::size_t size : options.sizes.empty() ? usual : options.sizes) tasks.push_back({&kind, size});
    }
    return tasks;
}

void print_list(const KernelFilter& filter) {
    for (const OperationKind& kind : operation_kinds()) {
        if (!filter.wants(kind)) continue;
        fmt::print("{} ({} {})\n", kind.name, fmt::join(kind.sizes, ", "), kind.items);
        for (const Shader* kernel : kind.kernels)
            if (filter.wants(kind, kernel->name)) fmt::print("    {}\n", kernel->name);
    }
}

std::string describe_differences(const Measurement& measurement) {
    std::string text;
    for (const Difference& difference : measurement.differences)
        text += fmt::format("{}{} {:.1e} ({:.0e})", text.empty() ? "" : ", ", difference.of, difference.largest,
                            difference.tolerance);
    return text;
}

void print_measurement(const Measurement& measurement, const Ceilings& ceilings) {
    if (!measurement.refused.empty()) {
        fmt::print("\n{}, {} {}: over this device's limits: {}\n", measurement.operation, measurement.size,
                   measurement.items, measurement.refused);
        return;
    }
    fmt::print("\n{}, {} {}; differences from the reference (allowed): {}\n", measurement.operation, measurement.size,
               measurement.items, describe_differences(measurement));
    if (!measurement.fits()) {
        fmt::print("    NOT AS THE REFERENCE: not timed\n");
        return;
    }
    print_kernel_rows(measurement, ceilings);
}

void print_comparison(const VariantComparison& comparison) {
    const double as_is = median(comparison.as_is);
    fmt::print("{} ({}, {}): {}{}\n    as it is {:.4f} ms", comparison.kernel, comparison.operation, comparison.size,
               comparison.parameter, comparison.judged == TuningMetric::end_to_end ? ", by whole runs" : "", as_is);
    for (const auto& [value, milliseconds] : comparison.milliseconds)
        fmt::print(", {}: {:.4f} ({:.2f}x){}", value, median(milliseconds), median(milliseconds) / as_is,
                   comparison.chosen == value ? " <- taken" : "");
    fmt::print("{}\n", comparison.chosen ? "" : "; stays as it is");
    for (const auto& [value, statistics] : comparison.statistics)
        if (!statistics.empty()) fmt::print("    {}: {}\n", value, statistics_text(statistics));
}

/// Prints progress between the tables, as a line rewritten in place would disturb them.
void print_progress(const ShaderBenchOptions& options, std::size_t done, std::size_t total, const Stopwatch& watch) {
    std::fflush(stdout);
    if (options.common.quiet || done == 0) return;
    const double left = watch.wall() * static_cast<double>(total - done) / static_cast<double>(done);
    fmt::print(stderr, "{} of {}, about {} left\n", done, total, format_seconds(left));
}

nlohmann::ordered_json device_json(const Device& device, const Ceilings& ceilings) {
    return to_json(DeviceReport{device.info(), ceilings});
}

void tune(Device& device, const std::vector<Task>& tasks, const KernelFilter& filter,
          const ShaderBenchOptions& options) {
    std::vector<std::string> known;
    nlohmann::ordered_json variants = nlohmann::ordered_json::array();
    const Stopwatch watch;
    for (std::size_t done = 0; const auto& [kind, size] : tasks) {
        check_interrupt();
        print_progress(options, done++, tasks.size(), watch);
        for (const VariantComparison& comparison :
             compare_variants(device, *kind, size, filter, {.repeats = options.repeats}, known)) {
            print_comparison(comparison);
            variants.push_back(to_json(comparison));
        }
    }
    const std::filesystem::path path = tuning_path(device.info());
    if (path.empty()) throw UsageError("there is no folder to keep the tuning in: set HOME or XDG_CACHE_HOME");
    device.tuning().save(path);
    if (!options.common.quiet)
        fmt::print("Kept in {}; what runs on this device uses it from now on. EXEMPLAR_TUNING=0 does without.\n",
                   path.string());
    const Ceilings ceilings = measure_ceilings(device);
    write_report(options.common, {{"device", device_json(device, ceilings)}, {"variants", variants}});
}

void measure(Device& device, const std::vector<Task>& tasks, const KernelFilter& filter,
             const ShaderBenchOptions& options) {
    std::vector<Measurement> before;
    if (!options.baseline.empty()) before = read_measurements(options.baseline, device.info());
    const Ceilings ceilings = measure_ceilings(device);
    print_ceilings(device, ceilings);
    std::vector<Measurement> measurements;
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    const TimingOptions timing{.repeats = options.repeats,
                               .wall_seconds = options.seconds / static_cast<double>(tasks.size())};
    const Stopwatch watch;
    for (const auto& [kind, size] : tasks) {
        check_interrupt();
        print_progress(options, measurements.size(), tasks.size(), watch);
        measurements.push_back(measure_operation(device, *kind, size, filter, timing, ceilings));
        print_measurement(measurements.back(), ceilings);
        list.push_back(to_json(measurements.back(), device, ceilings));
    }
    print_driver_statistics(device, measurements);
    write_report(options.common, {{"device", device_json(device, ceilings)}, {"measurements", list}});
    const auto wrong = std::ranges::count_if(measurements, [](const Measurement& m) { return !m.fits(); });
    if (wrong > 0)
        throw DeviceError(fmt::format("{} of {} operations differ from their reference on device '{}'", wrong,
                                      measurements.size(), device.info().name));
    if (!options.baseline.empty()) compare_with_earlier(measurements, before);
}

void run_compiler_statistics(const ShaderBenchOptions& options) {
    const KernelFilter filter(options.filter);
    if (options.in_this_process) compile_in_this_process(compiled_variants(filter));
    if (!options.common.device.empty())
        throw UsageError("--statistics compiles for cards that need not be there: give --families, not --device");
    StatisticsOptions compiling = options.compiling;
    compiling.common = options.common;
    compiling.baseline = options.baseline;
    run_statistics(compiling, {"bench", "shaders", "--statistics", "--in-this-process", "--filter", options.filter});
}

void run_shader_bench(const ShaderBenchOptions& options) {
    const auto limits = apply_common_options(options.common);
    if (options.statistics) return run_compiler_statistics(options);
    if (options.tune && !options.baseline.empty())
        throw UsageError("--tune compares variants with each other, --baseline with another report: give one of both");
    const KernelFilter filter(options.filter);
    if (options.list) return print_list(filter);
    const std::vector<Task> tasks = tasks_of(options, filter);
    Device device({.name = options.common.device, .statistics = true});
    options.tune ? tune(device, tasks, filter, options) : measure(device, tasks, filter, options);
}

/// Adds --statistics, which excludes `others`, and the options that belong to it.
void add_statistics_options(Command& command, ShaderBenchOptions& options, std::initializer_list<Option*> others) {
    Option* statistics =
        command.add_flag("--statistics", options.statistics,
                         "compile all variants with Mesa's compiler of AMD's cards, and print what it tells of them");
    for (const Option* other : others) statistics->excludes(other);
    command
        .add_option("--times", options.compiling.times,
                    "with --statistics: a report of --json, whose times are printed beside them")
        ->needs(statistics)
        ->type_name("FILE");
    add_family_options(command, statistics, options.compiling, options.in_this_process);
}

}  // namespace

void add_bench_shaders_command(Command& bench) {
    auto options = std::make_shared<ShaderBenchOptions>();
    Command* command =
        bench.add_subcommand("shaders", "Compares every kernel with its reference and times it on the device");
    command->footer(
        "Times are the device's own, of single runs: medians of repeats, and the standard error of these. Bytes and\n"
        "operations are the least that a run needs; 'copy' and 'fma' are the shares of what the device reaches when "
        "it\n"
        "only copies or only multiplies and adds. All kernels of an operation, and those that only copy or multiply,\n"
        "are timed in turns.\n\n"
        "Examples:\n"
        "  exemplar bench shaders --filter 'stumps|reproject' --json today.json\n"
        "  exemplar bench shaders --baseline today.json    exits with 1 if a kernel has become slower\n"
        "  exemplar bench shaders --tune                   finds the fastest variants and keeps them for this device\n"
        "  exemplar bench shaders --statistics             registers and occupancy on AMD's cards, without a card");
    command
        ->add_option("--filter", options->filter,
                     "only kernels, or operations, whose name this regular expression finds")
        ->type_name("REGEX");
    command->add_option("--baseline", options->baseline, "a report of --json to compare with")->type_name("FILE");
    Option* tune = command->add_flag(
        "--tune", options->tune,
        "compare variants of kernels (group sizes, items per invocation, how inputs are read and how many bits they "
        "have) and keep the fastest for this device");
    Option* sizes = command->add_option("--sizes", options->sizes, "how many items, instead of the usual three sizes")
                        ->check(whole_number(64, 4'000'000))
                        ->type_name("N");
    Option* repeats = command->add_option("--repeats", options->repeats, "how often each is timed")
                          ->capture_default_str()
                          ->check(whole_number(1, 1000));
    Option* seconds = command->add_option("--seconds", options->seconds, "how long timing may take, preparing aside")
                          ->capture_default_str()
                          ->check(in_range(0.1, 86400.0));
    Option* list =
        command->add_flag("--list", options->list, "print operations and their kernels, and measure nothing");
    add_statistics_options(*command, *options, {tune, sizes, repeats, seconds, list});
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_shader_bench(*options); });
}

}  // namespace exemplar
