#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "host/core/memory_budget.h"
#include "host/core/pipeline.h"
#include "host/data/catalog/catalog.h"
#include "host/data/catalog/shape_record.h"
#include "host/labeling/batch/batch_models.h"
#include "host/labeling/inference/labeler.h"
#include "host/labeling/inference/mesh_labeling.h"

namespace exemplar {

struct BatchOptions {
    std::filesystem::path cache;  ///< folder that remembers features; empty: none are remembered
    std::size_t memory = 0;       ///< bytes that shapes on their way may take
    std::size_t group = 8;        ///< meshes per submission to the device at most
};

/// A shape on its way through the stages. Once record.error says why it cannot be labeled, later stages let it pass.
struct BatchShape {
    CatalogShape shape;
    bool changed = false;  ///< the file is no longer what the catalog knew; `shape` tells what it is
    MemoryBudget::Share memory;
    TriangleMesh mesh;                  ///< as read
    WorkingFeatures prepared;           ///< its features, until it is scored
    const BatchModel* model = nullptr;  ///< what labels it
    FaceScores scores;
    FaceLabeling labeling;  ///< per triangle of `mesh`
    ShapeRecord record;     ///< all but run, worker and labels, which the writer knows
};

/// Labels shapes as they come, each independently of the others: read, features (on all cores, a mesh per core while
/// there are as many), device scores (several meshes per submission), graph cuts, writing, all at the same time.
/// `next` gives the shapes, called by one thread; `write` keeps the results, called by one thread, errors included.
/// A shape that cannot be read or labeled is an error in its record. What else goes wrong (the device, the disk,
/// Ctrl-C, what `next` and `write` throw) ends the work, and is thrown once nothing is at work any longer. Returns what
/// the stages did.
std::vector<StageLoad> label_batch(const std::function<std::optional<CatalogShape>()>& next,
                                   const std::function<void(BatchShape&)>& write, const BatchModels& models,
                                   const LabelingBackend& backend, const BatchOptions& options);

}  // namespace exemplar
