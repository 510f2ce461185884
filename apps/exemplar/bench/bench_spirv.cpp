// exemplar bench spirv: a compute shader of the user, checked and timed, alone or beside another version.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "apps/exemplar/bench/bench_kernel_table.h"
#include "apps/exemplar/bench/spirv_job.h"
#include "apps/exemplar/commands.h"
#include "gpu/runtime/kernels/capabilities.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"

namespace exemplar {
namespace {

/// The kernels of a job on a device, with the contents that both begin with.
struct SpirvRun {
    Contents contents;
    std::vector<std::unique_ptr<UserKernel>> kernels;
};

std::uint64_t thread_count(const SpirvVersion& version) {
    const auto threads = version.interface.threads(version.dispatch);
    return threads[0] * threads[1] * threads[2];
}

std::unique_ptr<SpirvRun> prepare(Device& device, const SpirvJob& job) {
    auto run = std::make_unique<SpirvRun>();
    std::vector<const UserInterface*> interfaces;
    interfaces.reserve(job.versions.size());
    std::uint64_t threads = 0;
    for (const SpirvVersion& version : job.versions) {
        interfaces.push_back(&version.interface);
        threads = std::max(threads, thread_count(version));
    }
    run->contents = contents_of_bindings(interfaces, job.sources, threads, device.info());
    run->kernels.reserve(job.versions.size());
    for (const SpirvVersion& version : job.versions)
        run->kernels.push_back(std::make_unique<UserKernel>(device, version.shader, version.interface, version.dispatch,
                                                            version.push, run->contents));
    return run;
}

std::string source_text(std::uint32_t binding, const SpirvJob& job, const Contents& contents) {
    const auto given = std::ranges::find(job.sources, binding, &BindingSource::binding);
    if (given == job.sources.end()) {
        const Bytes& bytes = contents.at(binding);
        const bool zeros = std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0}; });
        return zeros ? "zeros (nothing given)" : "random floats (nothing given)";
    }
    switch (given->kind) {
        case BindingSource::Kind::file:
            return given->path.string();
        case BindingSource::Kind::zeros:
            return "zeros";
        case BindingSource::Kind::random:
            return "random floats";
        case BindingSource::Kind::count:
            break;
    }
    return "0, 1, 2, ...";
}

std::string access_text(const ReflectedBinding& binding) {
    if (!binding.writes) return "read";
    return binding.reads ? "read, written" : "written";
}

void print_version(const SpirvVersion& version, const SpirvJob& job, const Contents& contents) {
    const auto& local = version.interface.reflection.local_size;
    const auto threads = version.interface.threads(version.dispatch);
    fmt::print("\n{}: {} x {} x {} threads in workgroups of {} x {} x {}\n", version.shader.name, threads[0],
               threads[1], threads[2], local[0], local[1], local[2]);
    for (const ReflectedBinding& binding : version.interface.reflection.bindings)
        fmt::print("    binding {} '{}' ({}): {}, {}\n", binding.binding, binding.name, access_text(binding),
                   format_bytes(contents.at(binding.binding).size()), source_text(binding.binding, job, contents));
}

void print_checks(const std::vector<CheckedBinding>& checks, double tolerance) {
    for (const CheckedBinding& check : checks) {
        const BufferComparison& comparison = check.comparison;
        const std::string worst = comparison.place.empty() ? std::string()
                                                           : fmt::format(" at {} ({}, expected {})", comparison.place,
                                                                         comparison.actual, comparison.expected);
        fmt::print("\nbinding {} '{}' beside {}: largest difference {:.3g}{}; {} of {} numbers over {:.0e}\n",
                   check.binding, check.name, check.with, comparison.largest, worst, comparison.differing,
                   comparison.numbers, tolerance);
    }
}

nlohmann::ordered_json check_json(const CheckedBinding& check, double tolerance) {
    return {{"binding", check.binding},
            {"with", check.with},
            {"largest", check.comparison.largest},
            {"tolerance", tolerance},
            {"place", check.comparison.place},
            {"differing", check.comparison.differing},
            {"numbers", check.comparison.numbers}};
}

nlohmann::ordered_json version_json(const SpirvVersion& version, const Contents& contents) {
    nlohmann::ordered_json bindings = nlohmann::ordered_json::array();
    for (const ReflectedBinding& binding : version.interface.reflection.bindings)
        bindings.push_back({{"binding", binding.binding},
                            {"name", binding.name},
                            {"reads", binding.reads},
                            {"writes", binding.writes},
                            {"bytes", contents.at(binding.binding).size()}});
    return {{"name", version.shader.name},
            {"local_size", version.interface.reflection.local_size},
            {"threads", version.interface.threads(version.dispatch)},
            {"bindings", std::move(bindings)}};
}

/// Runs each kernel once from its first contents, and compares what it writes.
std::vector<CheckedBinding> check_outputs(const SpirvJob& job, SpirvRun& run, const SpirvOptions& options) {
    for (const auto& kernel : run.kernels) {
        kernel->restore();
        kernel->run(1);
    }
    std::vector<CheckedBinding> checks;
    for (const auto& [binding, path] : job.expected)
        checks.push_back(
            compare_with_file(*run.kernels[0], job.versions[0].interface, binding, path, options.tolerance));
    if (run.kernels.size() > 1)
        std::ranges::move(compare_outputs(*run.kernels[0], *run.kernels[1], job.versions[0].interface,
                                          job.versions[1].shader.name, options.tolerance),
                          std::back_inserter(checks));
    return checks;
}

/// Throws Error naming the first binding that differs.
void require_fits(const SpirvJob& job, const std::vector<CheckedBinding>& checks, double tolerance) {
    for (const CheckedBinding& check : checks) {
        const BufferComparison& comparison = check.comparison;
        if (comparison.fits()) continue;
        throw Error(
            fmt::format("{}: binding {} '{}' differs from {} in {} of {} numbers, by up to {:.3g} at {} ({}, expected "
                        "{}), over the "
                        "--tolerance of {:g}; not timed",
                        job.versions[0].shader.name, check.binding, check.name, check.with, comparison.differing,
                        comparison.numbers, comparison.largest, comparison.place, comparison.actual,
                        comparison.expected, tolerance));
    }
}

/// Throws DeviceError with the first message of the validation layer, if it has any (EXEMPLAR_VALIDATION=1).
void require_no_messages(const Device& device, const std::string& shader) {
    const std::vector<std::string> messages = device.validation_messages();
    if (!messages.empty())
        throw DeviceError(fmt::format("{}: the validation layer says: {}", shader, messages.front()));
}

Work work_of(const SpirvOptions& options, const SpirvJob& job, const Contents& contents) {
    Work work{.bytes = options.bytes, .operations = options.operations};
    if (options.bytes > 0) return work;
    for (const ReflectedBinding& binding : job.versions[0].interface.reflection.bindings)
        work.bytes += static_cast<double>(contents.at(binding.binding).size());
    return work;
}

void print_ratio(const Measurement& measurement) {
    const auto& rows = measurement.kernels;
    if (rows.size() < 2) return;
    const Ratio ratio = ratio_of(rows[0].milliseconds, rows[1].milliseconds);
    fmt::print("\n{} takes {:.3f} +- {:.3f} of the time of {}: {}\n", rows[0].kernel, ratio.value,
               ratio.error * ratio.value, rows[1].kernel,
               ratio.is_faster(3, 0)   ? "faster"
               : ratio.is_slower(3, 0) ? "slower"
                                       : "no difference beyond three standard errors");
}

nlohmann::ordered_json report_json(const Device& device, const Ceilings& ceilings, const SpirvJob& job,
                                   const Contents& contents, const std::vector<CheckedBinding>& checks,
                                   const SpirvOptions& options) {
    nlohmann::ordered_json shaders = nlohmann::ordered_json::array(), list = nlohmann::ordered_json::array();
    for (const SpirvVersion& version : job.versions) shaders.push_back(version_json(version, contents));
    for (const CheckedBinding& check : checks) list.push_back(check_json(check, options.tolerance));
    return {{"device", to_json(DeviceReport{device.info(), ceilings})},
            {"shaders", std::move(shaders)},
            {"checks", std::move(list)},
            {"measurements", nlohmann::ordered_json::array()}};
}

void add_measurement(nlohmann::ordered_json& report, const Measurement& measurement, const Device& device,
                     const Ceilings& ceilings) {
    report["measurements"].push_back(to_json(measurement, device, ceilings));
    if (measurement.kernels.size() < 2) return;
    const Ratio ratio = ratio_of(measurement.kernels[0].milliseconds, measurement.kernels[1].milliseconds);
    report["ratio"] = {{"value", ratio.value}, {"relative_error", ratio.error}};
}

void measure_spirv(const SpirvOptions& options, const SpirvJob& job) {
    Device device({.name = options.common.device, .statistics = true, .features = compute_features()});
    for (const SpirvVersion& version : job.versions) require_capabilities(version.shader, device);
    std::vector<Measurement> before;
    if (!options.baseline.empty()) before = read_measurements(options.baseline, device.info());
    const auto run = prepare(device, job);
    for (const SpirvVersion& version : job.versions) print_version(version, job, run->contents);
    std::fflush(stdout);
    const std::vector<CheckedBinding> checks = check_outputs(job, *run, options);
    print_checks(checks, options.tolerance);
    require_no_messages(device, job.versions[0].shader.name);
    const Ceilings ceilings = measure_ceilings(device);
    nlohmann::ordered_json report = report_json(device, ceilings, job, run->contents, checks, options);
    if (std::ranges::any_of(checks, [](const CheckedBinding& check) { return !check.comparison.fits(); }))
        write_report(options.common, report);
    require_fits(job, checks, options.tolerance);

    std::vector<std::pair<std::string, UserKernel*>> kernels;
    for (std::size_t i = 0; i < run->kernels.size(); ++i)
        kernels.emplace_back(job.versions[i].shader.name, run->kernels[i].get());
    Measurement measurement = time_kernels(device, kernels, work_of(options, job, run->contents),
                                           {.repeats = options.repeats, .wall_seconds = options.seconds}, ceilings);
    measurement.size = thread_count(job.versions[0]);
    fmt::print("\n");
    print_ceilings(device, ceilings);
    print_kernel_rows(measurement, ceilings);
    print_ratio(measurement);
    print_driver_statistics(device, {measurement});
    add_measurement(report, measurement, device, ceilings);
    write_report(options.common, report);
    if (!options.baseline.empty()) compare_with_earlier({measurement}, before);
}

void run_spirv_bench(const SpirvOptions& options) {
    const auto limits = apply_common_options(options.common);
    if (options.statistics) return run_spirv_statistics(options);
    const SpirvJob job = read_spirv_job(options);
    if (!job.versions[0].shader.is_validated && !options.common.quiet)
        fmt::print(stderr,
                   "spirv-val is not installed (on Debian spirv-tools), so a damaged shader may crash the driver\n");
    check_interrupt();
    measure_spirv(options, job);
}

void add_input_options(Command& command, SpirvOptions& options) {
    command.add_option("SHADER", options.shader, "compute shader: SPIR-V, or GLSL (.comp, .glsl)")
        ->required()
        ->type_name("FILE");
    command
        .add_option("--bind", options.binds,
                    "contents of binding N: N=FILE (its bytes, or the array of a .npy), N=:BYTES (zeros), "
                    "N=random:COUNT (floats in [0, 1)), N=count:COUNT (0, 1, 2, ... as uints)")
        ->allow_extra_args(false)
        ->type_name("N=CONTENTS");
    command.add_option("--push", options.push, "push constants: numbers in the order of the members, with commas")
        ->type_name("NUMBERS");
    command.add_option("--spec", options.specs, "specialization constant: its constant_id and its value")
        ->allow_extra_args(false)
        ->type_name("ID=VALUE");
    Option* groups =
        command.add_option("--groups", options.groups, "workgroups: X, or X,Y or X,Y,Z")->type_name("X,Y,Z");
    command.add_option("--invocations", options.invocations, "invocations per axis, rounded up to whole workgroups")
        ->excludes(groups)
        ->type_name("X,Y,Z");
    command
        .add_option("--texels", options.texels, "bytes of a texel of the samplerBuffer at binding N: 4 or 16 (default)")
        ->allow_extra_args(false)
        ->type_name("N=BYTES");
    command.add_option("--include", options.includes, "folder that GLSL includes files of")
        ->allow_extra_args(false)
        ->type_name("FOLDER");
}

void add_check_options(Command& command, SpirvOptions& options) {
    command
        .add_option("--expect", options.expects,
                    "what binding N must hold after one run: N=FILE, or FILE for the only binding that is written")
        ->allow_extra_args(false)
        ->type_name("N=FILE");
    Option* against = command
                          .add_option("--against", options.against,
                                      "another version, which must write the same, and is timed in turns with the "
                                      "first")
                          ->type_name("FILE");
    command.add_option("--against-spec", options.against_specs, "specialization constant of the other version alone")
        ->needs(against)
        ->allow_extra_args(false)
        ->type_name("ID=VALUE");
    command.add_option("--against-groups", options.against_groups, "workgroups of the other version")
        ->needs(against)
        ->type_name("X,Y,Z");
    command
        .add_option("--tolerance", options.tolerance,
                    "allowed difference; of floats over 1, relative to the expected number")
        ->capture_default_str()
        ->check(in_range(0.0, 1e30));
}

void add_timing_options(Command& command, SpirvOptions& options) {
    command.add_option("--bytes", options.bytes, "bytes that a run must read and write, instead of all that are bound")
        ->check(in_range(0.0, 1e18));
    command.add_option("--operations", options.operations, "arithmetic operations of a run")
        ->check(in_range(0.0, 1e18));
    command.add_option("--repeats", options.repeats, "how often each is timed")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command.add_option("--seconds", options.seconds, "how long timing may take")
        ->capture_default_str()
        ->check(in_range(0.1, 86400.0));
    command.add_flag("--keep", options.keeps,
                     "do not restore, before each dispatch, the buffers that the kernel both reads and writes");
    command.add_option("--baseline", options.baseline, "a report of --json to compare with")->type_name("FILE");
}

void add_compiler_options(Command& command, SpirvOptions& options) {
    Option* statistics = command.add_flag("--statistics", options.statistics,
                                          "run nothing: compile with Mesa's compiler of AMD's cards, without a card, "
                                          "and print what it tells of the code");
    add_family_options(command, statistics, options.compiling, options.in_this_process);
}

}  // namespace

void add_bench_spirv_command(Command& bench) {
    auto options = std::make_shared<SpirvOptions>();
    Command* command = bench.add_subcommand("spirv", "Checks and times a compute shader of your own");
    command->footer(
        "Bindings that are not given hold as many elements as there are threads: random floats where the shader reads\n"
        "floats, else zeros. Times are the device's own; 'copy' and 'fma' are shares of what the device reaches when "
        "it\n"
        "only copies or only multiplies and adds.\n\n"
        "Examples:\n"
        "  exemplar bench spirv saxpy.comp --invocations 1M --push 1048576,2 --bind 0=random:1M --bind 1=random:1M\n"
        "  exemplar bench spirv new.spv --against old.spv --groups 4096 --bind 0=in.bin --json new.json\n"
        "  exemplar bench spirv new.spv --groups 4096 --bind 0=in.bin --expect 1=out.bin --baseline new.json\n"
        "  exemplar bench spirv new.spv --statistics --families NAVI21    registers and occupancy, without a card");
    add_input_options(*command, *options);
    add_check_options(*command, *options);
    add_timing_options(*command, *options);
    add_compiler_options(*command, *options);
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    command->callback([options] { run_spirv_bench(*options); });
}

}  // namespace exemplar
