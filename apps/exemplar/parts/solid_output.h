#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "host/parts/prototype/print_solid.h"

namespace exemplar {

/// Writes an STL file per solid, and all.stl with all of them in place. Returns their description for reports (see
/// docs/formats.md).
nlohmann::json write_solids(const std::vector<PrintSolid>& solids, const std::filesystem::path& folder);

}  // namespace exemplar
