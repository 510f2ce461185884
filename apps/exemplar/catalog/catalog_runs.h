#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/data/catalog/catalog_run.h"

namespace exemplar {

/// Returns a time of a catalog as "2026-03-01 09:30:00" in UTC; empty for none.
std::string format_time(double seconds_since_1970);
/// Describes a shape; the key `features` tells whether its features are in the folder `cache`.
nlohmann::json describe_shape_row(const CatalogShape& shape, const std::filesystem::path& cache);
/// Returns the run of that number, or the latest run if it is 0; nothing if there is no run. Throws DataError.
std::optional<CatalogRun> chosen_run(Catalog& catalog, std::int64_t number);

}  // namespace exemplar
