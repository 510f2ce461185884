#include "apps/exemplar/catalog/catalog_runs.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>

namespace exemplar {

namespace fs = std::filesystem;

std::string format_time(double seconds_since_1970) {
    // Years of four digits; this program never writes others.
    if (!(seconds_since_1970 > 0) || seconds_since_1970 > 2.5e11) return {};
    return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(static_cast<std::time_t>(seconds_since_1970)));
}

nlohmann::json describe_shape_row(const CatalogShape& shape, const fs::path& cache) {
    std::error_code ignored;
    const bool cached = !shape.features.empty() && fs::exists(cache / fs::path(shape.features).filename(), ignored);
    return {{"id", shape.id},
            {"path", shape.path.string()},
            {"name", shape.name},
            {"bytes", shape.bytes},
            {"hash", shape.hash},
            {"vertices", shape.vertices},
            {"faces", shape.faces},
            {"components", shape.components},
            {"usable", shape.problem.empty()},
            {"problem", shape.problem},
            {"warnings", shape.warnings},
            {"category", shape.category},
            {"features", cached}};
}

std::optional<CatalogRun> chosen_run(Catalog& catalog, std::int64_t number) {
    if (number > 0) return CatalogRun(catalog, number);
    const std::vector<RunSummary> runs = runs_of(catalog);
    if (runs.empty()) return {};
    return CatalogRun(catalog, runs.back().id);
}

}  // namespace exemplar
