#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/help/command.h"

namespace exemplar {

/// Options that subcommands share.
struct CommonOptions {
    std::string device;          ///< index or name; empty = EXEMPLAR_DEVICE or the best
    std::size_t threads = 0;     ///< 0 = all cores
    bool quiet = false;          ///< no progress, no remarks
    std::filesystem::path json;  ///< report as JSON; empty = none
};

/// Adds --device to a subcommand that computes on a device.
void add_device_option(Command& command, CommonOptions& options);
/// Adds --threads, --quiet and --json to a subcommand.
void add_common_options(Command& command, CommonOptions& options);
/// Adds --memory, in GB; 0 leaves it to the program.
void add_memory_option(Command& command, double& gigabytes);
/// Returns the value of --memory in bytes; 0 if it was not given.
std::size_t memory_of_option(double gigabytes);
/// Puts --threads and --quiet into effect; called first by every subcommand. The result holds the thread limit.
std::shared_ptr<void> apply_common_options(const CommonOptions& options);
/// Writes a JSON file atomically; replaces text that is not UTF-8.
void write_json(const std::filesystem::path& path, const nlohmann::json& json);
/// Writes a report to the file of --json, if there is one.
void write_report(const CommonOptions& options, const nlohmann::json& report);

// One function per file of the same name: adds the subcommand, whose callback does the work and throws Error.
void add_devices_command(Command& app);
void add_doctor_command(Command& app);
void add_features_command(Command& app);
void add_synth_command(Command& app);
void add_label_command(Command& app);
void add_train_command(Command& label);
void add_apply_command(Command& label);
void add_batch_command(Command& label);
void add_evaluate_command(Command& label);
void add_stress_command(Command& label);
void add_category_command(Command& app);
void add_category_train_command(Command& category);
void add_category_apply_command(Command& category);
void add_category_evaluate_command(Command& category);
void add_curvature_command(Command& app);
void add_curvature_train_command(Command& curvature);
void add_curvature_evaluate_command(Command& curvature);
void add_curvature_study_command(Command& curvature);
void add_lines_command(Command& app);
void add_hatch_command(Command& app);
void add_hatch_template_command(Command& hatch);
void add_hatch_example_command(Command& hatch);
void add_hatch_extract_command(Command& hatch);
void add_hatch_train_command(Command& hatch);
void add_hatch_draw_command(Command& hatch);
void add_hatch_evaluate_command(Command& hatch);
void add_catalog_command(Command& app);
void add_catalog_add_command(Command& catalog);
void add_catalog_list_command(Command& catalog);
void add_catalog_status_command(Command& catalog);
void add_catalog_export_command(Command& catalog);
void add_catalog_merge_command(Command& catalog);
void add_demo_command(Command& app);
void add_bench_command(Command& app);
void add_bench_shaders_command(Command& bench);

}  // namespace exemplar
