#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/report/report_page.h"

namespace exemplar {

/// Converts a category of the report of `label evaluate` to a group of the page, without its meshes.
ReportData report_group(const nlohmann::json& category);

/// Returns the indices of the test meshes of a split that the page shows: the worst ones, then the middle and the
/// best.
std::vector<std::size_t> shown_meshes(const nlohmann::json& split);

}  // namespace exemplar
