#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>

#include "apps/exemplar/label/evaluation_run.h"

namespace exemplar {

// Labels that another program gave test meshes: FOLDER/CATEGORY/NAME_labels.txt, or, of a single category, also
// FOLDER/NAME_labels.txt.

/// Throws DataError if the folder has labels for no test mesh.
void require_peer(std::span<const EvaluationTask> tasks, const std::filesystem::path& folder);

/// Rates the labels of the folder beside those of an evaluation: adds `peer` to each mesh that it has labels for, to
/// its category and to the report (docs/formats.md). Throws DataError for labels of other faces than a mesh has.
void compare_with_peer(nlohmann::json& report, std::span<const EvaluationTask> tasks,
                       const std::filesystem::path& folder);

/// Prints, per category, the rates of both, and on how many meshes each of them is ahead.
void print_peer(const nlohmann::json& report);

}  // namespace exemplar
