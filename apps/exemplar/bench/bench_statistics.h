#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/bench/kernels/compiled_variants.h"
#include "apps/exemplar/common_options.h"

namespace exemplar {

/// Options of --statistics.
struct StatisticsOptions {
    CommonOptions common;
    std::filesystem::path baseline;  ///< a report of earlier statistics; empty: none
    std::filesystem::path times;     ///< a report of measured times; empty: none
    std::vector<std::string> families{"NAVI21", "VEGA10"};
};

/// Adds --families, and the hidden option of the child process; both need `statistics`, the option --statistics.
void add_family_options(Command& command, Option* statistics, StatisticsOptions& options, bool& in_this_process);

/// Compiles kernels with Mesa's RADV for each family of graphics cards, whose hardware is not needed, and prints what
/// the compiler tells of them. `child` are the words after this program's name that make it call
/// compile_in_this_process. Throws Error if a default variant is worse than in the baseline.
void run_statistics(const StatisticsOptions& options, const std::vector<std::string>& child);

/// Compiles the variants with the first driver of this process, and prints their statistics as one line of JSON. Does
/// not return, as Mesa's device without hardware cannot be closed.
[[noreturn]] void compile_in_this_process(const std::vector<CompiledVariant>& variants);

}  // namespace exemplar
