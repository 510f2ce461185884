#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/labeling/training/fold_boosting.h"
#include "host/labeling/training/training.h"

namespace exemplar {

/// Values of the items of each mesh.
using PerMesh = std::vector<std::vector<float>>;

/// The feature columns of one cascade. Coordinates and context are appended when a mesh is asked for, because a mesh
/// that was read again lacks them.
struct CascadeColumns {
    TrainingFeatures& features;
    FeatureMatrix MeshFeatures::*matrix;
    std::size_t of_mesh;         ///< columns of the mesh alone
    std::size_t base = of_mesh;  ///< with coordinates, if the cascade has them
    std::size_t context = 0;     ///< contextual columns of the stages after the first
    /// Appends the contextual columns of a mesh, from the out-of-fold probabilities (items x classes) of the last
    /// stage.
    std::function<void(MeshFeatures&, std::span<const float> probabilities)> add_context = {};
    const PerMesh* probabilities = nullptr;  ///< of the last stage; null in the first stage
    std::vector<bool> is_stale = {};         ///< per mesh: its contextual columns are those of an earlier stage

    /// Begins a stage after the first, whose context is computed from these.
    void begin_stage(const PerMesh& of_last_stage);
    std::size_t count() const { return base + (probabilities ? context : 0); }
    /// Returns the first count() columns of a mesh, and perhaps more.
    const FeatureMatrix& of(std::size_t mesh);
};

/// A cascade to train. Each stage after the first also sees contextual features, computed from the predictions of the
/// stage before.
struct Cascade {
    std::string name;
    std::size_t max_cascade_stages;
    double max_loss_ratio;     ///< a stage is kept if its loss is below this factor times that of the stage before
    FoldBoostingOptions task;  ///< its number of features and seed are set per stage
    CascadeColumns& columns;
    std::vector<BoostingItems> items = {};         ///< per mesh
    std::optional<FoldBoostingResult> first = {};  ///< the first stage, if it is trained already

    /// Adds the items of the next mesh.
    void add_items(std::span<const std::int32_t> label, std::span<const float> weight,
                   std::span<const std::uint8_t> fold);
};

/// Runs one boosting task over all meshes, shows its progress and adds it to the report.
FoldBoostingResult run_stage(const std::string& what, std::span<const BoostingItems> items, FoldBoostingOptions options,
                             const TrainOptions& train, StumpScorer& scorer, TrainReport& report);

/// Trains stage after stage until the out-of-fold loss rises; returns the out-of-fold probabilities of the last kept
/// one. If `averaged` is given, sets it to the labels of one fold only, which are averaged over the stages (see
/// CascadePrediction).
PerMesh train_cascade(Cascade cascade, const TrainOptions& options, StumpScorer& scorer,
                      std::vector<CalibratedStumps>& classifiers, std::vector<LinearExpert>& linear,
                      std::vector<std::uint32_t>* averaged, TrainReport& report);

}  // namespace exemplar
