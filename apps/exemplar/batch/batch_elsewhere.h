#pragma once

#include "apps/exemplar/batch/batch_command.h"
#include "host/data/catalog/catalog_run.h"
#include "host/data/catalog/shard.h"

namespace exemplar {

/// Leaves what a run has still to label to tasks, of Slurm or by hand, and takes over what others have labeled. If
/// tasks of an earlier call are still at work, it waits for them first, or throws DataError if it is not to wait.
void run_elsewhere(const BatchCommand& options, Catalog& catalog, CatalogRun& run, const BatchPlan& plan);

}  // namespace exemplar
