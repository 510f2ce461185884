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
#include "host/mesh/io/io.h"

namespace exemplar {

struct BatchOptions {
    std::filesystem::path cache;  ///< folder of the feature cache; empty: no cache
    std::size_t memory = 0;       ///< bytes that the shapes in the pipeline may take together
    std::size_t group = 8;        ///< maximum meshes per submission to the device
};

/// A shape in the pipeline. If a stage sets record.error, the later stages skip the shape.
struct BatchShape {
    CatalogShape shape;
    bool changed = false;  ///< the file differs from its catalog entry; `shape` describes the new content
    MemoryBudget::Share memory;
    MeshFile file;                      ///< as read
    WorkingFeatures prepared;           ///< its features, until its labels are cut
    const BatchModel* model = nullptr;  ///< the model that labels it
    FaceScores scores;
    FaceLabeling labeling;  ///< per triangle of the mesh
    ShapeRecord record;     ///< complete except run, worker and labels, which the writer sets
};

/// Labels a stream of shapes, independently of each other. The stages run concurrently: read, features (on all cores,
/// one mesh per core while enough are waiting), scores (several meshes per submission to the device), cuts, writing.
/// `next` supplies the shapes and `write` stores the results, including failed shapes; each is called by one thread.
/// If a shape cannot be read or labeled, its record holds the error. Any other failure (device, disk, Ctrl-C, an
/// exception of `next` or `write`) ends the run and is thrown after all stages have stopped. Returns the load of each
/// stage.
std::vector<StageStatistics> label_batch(const std::function<std::optional<CatalogShape>()>& next,
                                         const std::function<void(BatchShape&)>& write, const BatchModels& models,
                                         const LabelingBackend& backend, const BatchOptions& options);

}  // namespace exemplar
