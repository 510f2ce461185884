// --statistics of exemplar bench shaders and bench spirv: what the compiler of graphics cards tells of kernels, without
// a card.

#include "apps/exemplar/bench/bench_statistics.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "apps/bench/kernels/compiler_statistics.h"
#include "apps/exemplar/run_words.h"
#include "gpu/runtime/kernels/capabilities.h"
#include "gpu/runtime/measure/setup_check.h"
#include "gpu/runtime/vulkan/errors.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/json_text.h"
#include "host/core/parallel.h"
#include "host/core/text.h"

namespace exemplar {
namespace {

/// Returns the files of Mesa's driver of AMD's cards, separated by colons.
std::string radv_files() {
    std::string files;
    for (const std::filesystem::path& file : driver_files(this_machine())) {
        std::error_code error;
        if (!file.filename().string().starts_with("radeon_icd") || !std::filesystem::exists(file, error)) continue;
        if (!files.empty()) files += ':';
        files += file.string();
    }
    if (files.empty())
        throw NoDeviceError(
            "--statistics needs Mesa's driver of AMD's cards (radeon_icd.*.json in /usr/share/vulkan/icd.d); install "
            "mesa-vulkan-drivers");
    return files;
}

/// Returns the last line of a text that is not empty.
std::string last_line(const std::string& text) {
    const std::size_t end = text.find_last_not_of('\n') + 1;
    return text.substr(0, end).substr(text.substr(0, end).rfind('\n') + 1);
}

/// Returns the families in capitals, as Mesa names them; each once.
std::vector<std::string> family_names(const std::vector<std::string>& words) {
    std::vector<std::string> names;
    for (std::string word : words) {
        std::ranges::transform(word, word.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
        if (std::ranges::find(names, word) == names.end()) names.push_back(word);
    }
    return names;
}

/// Runs this program again with a driver that takes itself for one of a card of the family.
FamilyStatistics compile_for(const std::string& family, const std::string& files,
                             const std::vector<std::string>& child) {
    std::vector<std::string> words{this_program().string()};
    words.insert(words.end(), child.begin(), child.end());
    const ProgramOutput output = run_words(words, {{"RADV_FORCE_FAMILY", family},
                                                   {"VK_ICD_FILENAMES", files},
                                                   {"VK_DRIVER_FILES", files},
                                                   {"EXEMPLAR_VALIDATION", "0"},
                                                   {"EXEMPLAR_DEVICE", "0"}});
    check_interrupt();
    if (output.text.find("Unknown family") != std::string::npos)
        throw UsageError(
            fmt::format("--families: Mesa knows no family '{}' here; it may know POLARIS10, VEGA10, NAVI10, NAVI21, "
                        "GFX1100 or NAVI31",
                        family));
    const std::string line = last_line(output.text);
    if (output.code != 0)
        throw DeviceError(fmt::format("compiling for {}: {}", family,
                                      line.starts_with("error: ") ? line.substr(7) : "the driver crashed: " + line));
    try {
        FamilyStatistics statistics = family_statistics(parse_json(line));
        statistics.family = family;
        return statistics;
    } catch (const nlohmann::json::exception&) {
        throw DeviceError(fmt::format("compiling for {}: the answer of '{}' is damaged", family, files));
    }
}

/// Returns the rows of a table, the first with the names of its columns.
std::vector<std::vector<std::string>> table_of(const FamilyStatistics& statistics, const ReportedTimes& times) {
    std::vector<std::vector<std::string>> rows{{"  kernel", "variant"}};
    for (const CodeNumber& number : k_code_numbers)
        if (number.header) rows.front().emplace_back(number.header);
    if (!times.device.empty()) rows.front().emplace_back("ms");
    rows.reserve(statistics.kernels.size() + 1);
    for (const CodeStatistics& code : statistics.kernels) {
        std::vector<std::string>& row = rows.emplace_back();
        row = {(code.is_default ? "* " : "  ") + code.kernel, code.variant};
        for (const CodeNumber& number : k_code_numbers) {
            if (!number.header) continue;
            const auto value = code.numbers.find(number.key);
            row.push_back(value == code.numbers.end() ? "-" : std::to_string(value->second));
        }
        if (times.device.empty()) continue;
        const auto time = times.milliseconds.find(code.kernel);
        row.push_back(time == times.milliseconds.end() ? "-" : fmt::format("{:.3f}", time->second));
    }
    return rows;
}

void print_statistics(const FamilyStatistics& statistics, const ReportedTimes& times) {
    constexpr std::size_t k_first_number = 2;  // from here on columns are aligned to the right
    const std::vector<std::vector<std::string>> rows = table_of(statistics, times);
    std::vector<std::size_t> widths(rows.front().size());
    for (const auto& row : rows)
        for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
    fmt::print("\n{}: {}, {}; * is what runs by default{}\n", statistics.family, statistics.device, statistics.driver,
               times.device.empty() ? "" : "; ms on " + times.device);
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c)
            line += c < k_first_number ? fmt::format("{:<{}}", row[c], widths[c] + 2)
                                       : fmt::format("{:>{}}  ", row[c], widths[c]);
        fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
    }
}

/// Returns the family's statistics in the baseline.
const FamilyStatistics& baseline_of(const FamilyStatistics& now, const std::vector<FamilyStatistics>& before,
                                    const StatisticsOptions& options) {
    const auto found = std::ranges::find(before, now.family, &FamilyStatistics::family);
    if (found == before.end())
        throw UsageError(fmt::format("{}: it has no family {}; choose others with --families",
                                     options.baseline.string(), now.family));
    if (found->driver != now.driver)
        throw UsageError(fmt::format("{}: it was compiled by {}, this is {}, and compilers differ; make it anew",
                                     options.baseline.string(), found->driver, now.driver));
    return *found;
}

/// Prints all changes since the baseline. Throws Error if a default variant is worse.
void compare_with_baseline(const std::vector<FamilyStatistics>& now, const std::vector<FamilyStatistics>& before,
                           const StatisticsOptions& options) {
    std::size_t changed = 0, faults = 0;
    for (const FamilyStatistics& family : now)
        for (const CodeChange& change : changes_between(family, baseline_of(family, before, options))) {
            if (changed++ == 0) fmt::print("\nChanges since the baseline:\n");
            faults += change.is_fault();
            fmt::print("    {:<8} {}{}: {} {} -> {}{}\n", family.family, change.kernel,
                       change.variant.empty() ? "" : " (" + change.variant + ")", change.number, change.before,
                       change.now,
                       !change.is_worse    ? ""
                       : change.is_fault() ? "  WORSE"
                                           : "  worse, accepted: " + change.accepted);
        }
    if (changed == 0) fmt::print("\nNothing has changed since the baseline.\n");
    if (faults > 0)
        throw Error(fmt::format(
            "{} numbers of kernels that graphics cards run by default are worse than in the baseline", faults));
}

}  // namespace

void add_family_options(Command& command, Option* statistics, StatisticsOptions& options, bool& in_this_process) {
    command.add_option("--families", options.families, "with --statistics: families of cards, as Mesa names them")
        ->delimiter(',')
        ->needs(statistics)
        ->capture_default_str()
        ->type_name("NAME");
    command.add_flag("--in-this-process", in_this_process, "compile with this process's driver")
        ->needs(statistics)
        ->hide();
}

void run_statistics(const StatisticsOptions& options, const std::vector<std::string>& child) {
    std::vector<FamilyStatistics> before;
    if (!options.baseline.empty()) before = read_statistics(options.baseline);
    const ReportedTimes times = options.times.empty() ? ReportedTimes{} : read_times(options.times);
    const std::string files = radv_files();
    const std::vector<std::string> names = family_names(options.families);
    if (!options.common.quiet) fmt::print(stderr, "compiling for {}\n", fmt::join(names, ", "));
    std::vector<FamilyStatistics> families(names.size());
    parallel_for(names.size(), [&](std::size_t i) { families[i] = compile_for(names[i], files, child); });
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const FamilyStatistics& family : families) {
        print_statistics(family, times);
        list.push_back(to_json(family));
    }
    write_report(options.common, {{"families", list}});
    if (!options.baseline.empty()) compare_with_baseline(families, before, options);
}

void compile_in_this_process(const std::vector<CompiledVariant>& variants) {
    // Never deleted: if compiling fails, the driver would crash before the error is printed.
    Device& device = *new Device({.statistics = true, .compile_only = true, .features = compute_features()});  // NOLINT
    if (!device.captures_statistics())
        throw DeviceError(fmt::format("'{}' tells no statistics of its code", device.info().name));
    FamilyStatistics statistics{
        .family = {}, .device = device.info().name, .driver = device.info().driver_version, .kernels = {}};
    statistics.kernels.reserve(variants.size());
    for (const CompiledVariant& variant : variants) {
        check_interrupt();
        statistics.kernels.push_back(compile_variant(device, variant));
    }
    fmt::print("\n{}\n", ordered_json_text(to_json(statistics)));
    std::fflush(stdout);
    _exit(0);
}

}  // namespace exemplar
