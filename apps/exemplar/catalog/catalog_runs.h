#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/data/catalog/catalog_run.h"

namespace exemplar {

/// A time of a catalog as "2026-03-01 09:30:00" in UTC; empty for none.
std::string format_time(double seconds_since_1970);
/// What is known of a shape; `features` tells whether those are in the folder `cache`.
nlohmann::json describe_shape_row(const CatalogShape& shape, const std::filesystem::path& cache);
/// The run that a user means: by number, or the latest if there is none. Nothing if nothing was run. Throws DataError.
std::optional<CatalogRun> chosen_run(Catalog& catalog, std::int64_t number);

}  // namespace exemplar
