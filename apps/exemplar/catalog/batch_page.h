#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "host/core/pipeline.h"
#include "host/data/catalog/catalog_run.h"

namespace exemplar {

/// Work of one call of `label batch`; empty for a page that is made from the catalog alone.
struct BatchReport {
    std::vector<StageStatistics> stages;
    std::size_t shapes = 0;  ///< that it labeled or tried to
    double seconds = 0;      ///< wall time
};

/// Writes OUT/index.html, a page about a run of any number of shapes (see write_report_page): outcomes, stages,
/// categories, labels, errors, the shapes of lowest confidence, and some labeled shapes to turn, read from the run's
/// folder. It stays below about 20 MB. Throws DataError if it cannot be written.
void write_batch_page(const std::filesystem::path& out, Catalog& catalog, CatalogRun& run, const BatchReport& report);

}  // namespace exemplar
