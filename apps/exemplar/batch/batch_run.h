#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/exemplar/backend.h"
#include "apps/exemplar/batch/batch_work.h"

namespace exemplar {

/// Work of one program on a batch run.
struct BatchResult {
    BatchCounts counts;
    std::vector<StageStatistics> stages;
    double wall = 0, cpu = 0;  ///< seconds
};

/// Labels the shapes of `work`, with progress. Throws Interrupted at Ctrl-C, and the error that ends the work.
BatchResult run_work(BatchWork& work, const BatchWriter& writer, const BatchModels& models, DeviceBackend& backend,
                     const BatchOptions& options);

void print_result(const BatchResult& result);
nlohmann::json describe(const BatchResult& result);

}  // namespace exemplar
