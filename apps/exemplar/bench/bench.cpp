// exemplar bench: what the operations of labeling cost here, beside goals and others' figures.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/bench/bench_rows.h"
#include "apps/exemplar/commands.h"
#include "apps/help/command.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

struct BenchOptions {
    CommonOptions common;
    std::filesystem::path meshes;
    std::vector<std::string> only;
    bool full = false, quick = false;
};

constexpr std::array<BenchPart, 11> k_parts{{{"features", false, bench_features},
                                             {"train", false, bench_training},
                                             {"label", false, bench_labeling},
                                             {"boosting", false, bench_boosting},
                                             {"scoring", false, bench_scoring},
                                             {"cut", false, bench_cut},
                                             {"curvature", false, bench_curvature},
                                             {"lines", false, bench_lines},
                                             {"host", false, bench_host_work},
                                             {"scaling", true, bench_scaling},
                                             {"arrangements", true, bench_arrangements}}};

std::vector<std::string> part_names() {
    std::vector<std::string> names;
    names.reserve(k_parts.size());
    for (const BenchPart& part : k_parts) names.emplace_back(part.name);
    return names;
}

/// The parts to run, in the table's order. Throws UsageError for a name that is none.
std::vector<BenchPart> chosen_parts(const BenchOptions& options) {
    const std::vector<std::string> names = part_names();
    for (const std::string& name : options.only)
        if (std::ranges::find(names, name) == names.end())
            throw UsageError(fmt::format("nothing called '{}' is measured{}; --only takes {}", name,
                                         suggestion(name, names), fmt::join(names, ", ")));
    std::vector<BenchPart> parts;
    for (const BenchPart& part : k_parts) {
        const bool named = std::ranges::find(options.only, part.name) != options.only.end();
        if (options.only.empty() ? options.full || !part.only_full : named) parts.push_back(part);
    }
    return parts;
}

void run_bench(const BenchOptions& options) {
    const auto limits = apply_common_options(options.common);
    const std::vector<BenchPart> parts = chosen_parts(options);
    if (!options.meshes.empty()) meshes_of_argument(options.meshes);
    BenchContext context({options.meshes, options.common.device, options.quick});
    nlohmann::json rows = nlohmann::json::array();
    print_header();
    for (const BenchPart& part : parts) {
        check_interrupt();
        part.run(context, [&](const BenchRow& row) {
            print_row(row);
            rows.push_back(describe_row(row));
        });
    }
    write_report(options.common, {{"runs", context.runs()}, {"rows", rows}});
}

}  // namespace

void add_bench_command(Command& app) {
    auto options = std::make_shared<BenchOptions>();
    Command* command = app.add_subcommand("bench", "Measures speed and memory, beside goals and others' figures");
    command->footer(
        "Times are medians of three runs, of long ones a single run; CPU times are those of all threads; peak is the\n"
        "memory of the process.\n"
        "'plain, one thread' is the same run on one thread and without a device.\n"
        "Others' figures were measured on other machines or data: they tell an order of magnitude.\n\nExample:\n"
        "  exemplar bench --only cut scoring --json bench.json");
    command
        ->add_option("--meshes", options->meshes,
                     "labeled meshes (folder, or a list) to measure on, instead of six generated quadrupeds")
        ->type_name("LIST");
    command->add_option("--only", options->only, fmt::format("measure only these: {}", fmt::join(part_names(), " ")))
        ->check(completion_words(part_names()))
        ->type_name("NAME");
    command->add_flag("--full", options->full,
                      "also how costs grow up to two million faces, and with faces arranged on purpose to cost much, "
                      "which takes many minutes");
    command->add_flag("--quick", options->quick, "one run of each, and none on one thread that takes long");
    add_device_option(*command, options->common);
    add_common_options(*command, options->common);
    add_bench_shaders_command(*command);
    add_bench_outlines_command(*command);
    // Without a subcommand of its own.
    command->callback([options, command] {
        if (!command->has_given_subcommand()) run_bench(*options);
    });
}

}  // namespace exemplar
