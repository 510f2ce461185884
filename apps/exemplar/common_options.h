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

}  // namespace exemplar
