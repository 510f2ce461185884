#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/help/command.h"

namespace exemplar {

/// The formats of meshes and animations, for the descriptions of arguments.
inline constexpr const char* k_mesh_argument =
    "mesh: OFF, OBJ, PLY, STL, glTF, and where exemplar-import is installed FBX, COLLADA, 3MF, 3DS";
inline constexpr const char* k_surface_argument =
    "mesh (OFF, OBJ, PLY, STL, glTF, and where exemplar-import is installed FBX, COLLADA, 3MF, 3DS) or animation "
    "(glTF, FBX, COLLADA, folder)";
inline constexpr const char* k_animation_argument =
    "animation: glTF file, FBX or COLLADA file where exemplar-import is installed, or a folder of meshes";
inline constexpr const char* k_fps_option = "frames a second that clips of files, not of folders, are sampled at";

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
