#pragma once

#include "apps/exemplar/batch/batch_command.h"
#include "host/data/catalog/catalog_run.h"
#include "host/data/catalog/shard.h"

namespace exemplar {

/// Divides the remaining shapes of a run among tasks, run by Slurm or by hand, and merges the results of other
/// programs. If tasks of an earlier call are still running, waits for them first, or throws DataError without
/// --wait.
void run_as_tasks(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan);

}  // namespace exemplar
