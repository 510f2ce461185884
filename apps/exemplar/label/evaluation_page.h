#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "apps/report/report_page.h"

namespace exemplar {

/// A category of the report of `label evaluate` as a group of the page: all but its meshes.
ReportData report_group(const nlohmann::json& category);

/// Which test meshes of a split the page shows, as positions in it: the worst ones, then the middle and the best one.
std::vector<std::size_t> shown_meshes(const nlohmann::json& split);

}  // namespace exemplar
