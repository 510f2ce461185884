#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "apps/exemplar/label/evaluation_run.h"

namespace exemplar {

/// Rates the labels that another program gave the test meshes, FOLDER/CATEGORY/NAME_labels.txt or
/// FOLDER/NAME_labels.txt, beside those of an evaluation: adds `peer` to each mesh that it has labels for, to its
/// category and to the report (docs/formats.md). Throws DataError if it has labels for no mesh, or for other faces than
/// a mesh has.
void compare_with_peer(nlohmann::json& report, std::span<const EvaluationTask> tasks,
                       const std::filesystem::path& folder);

/// Prints, per category, the rates of the other program and on how many meshes each of both is ahead.
void print_peer(const nlohmann::json& report);

}  // namespace exemplar
