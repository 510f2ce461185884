#include "host/labeling/training/cascade_training.h"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "host/core/progress.h"
#include "host/core/stopwatch.h"
#include "host/labeling/inference/cascade_prediction.h"
#include "host/labeling/inference/mesh_turn.h"

namespace exemplar {

void CascadeColumns::begin_stage(const PerMesh& of_last_stage) {
    probabilities = &of_last_stage;
    is_stale.assign(features.count(), true);
}

const FeatureMatrix& CascadeColumns::of(std::size_t m) {
    MeshFeatures& mesh = features.at(m);
    if (base > of_mesh && (mesh.*matrix).cols() < base) set_orientation(mesh, of_mesh, Eigen::Matrix3f::Identity());
    if (probabilities && (is_stale[m] || (mesh.*matrix).cols() < count())) {
        add_context(mesh, (*probabilities)[m]);
        is_stale[m] = false;
    }
    return mesh.*matrix;
}

void Cascade::add_items(std::span<const std::int32_t> label, std::span<const float> weight,
                        std::span<const std::uint8_t> fold) {
    items.push_back({[&columns = columns, m = items.size()]() -> const FeatureMatrix& { return columns.of(m); }, label,
                     weight, fold});
}

FoldBoostingResult run_stage(const std::string& what, std::span<const BoostingItems> items, FoldBoostingOptions options,
                             const TrainOptions& train, StumpScorer& scorer, TrainReport& report) {
    options.rounds = train.rounds, options.bins = train.bins;
    options.rows_per_mesh = train.rows_per_mesh;
    options.feature_fraction = train.feature_fraction, options.shrinkage = train.shrinkage;
    Progress progress("training " + what + " (rounds)", (options.folds + 1) * options.rounds);
    const Stopwatch watch;
    FoldBoostingResult result = boost_with_folds(items, options, scorer, [&] { progress.advance(); });
    progress.finish();
    report.stages.push_back(
        {what, result.rounds, result.loss, result.stumps_loss, result.error, true, result.curve, watch.wall()});
    return result;
}

PerMesh train_cascade(Cascade cascade, const TrainOptions& options, StumpScorer& scorer,
                      std::vector<CalibratedStumps>& classifiers, std::vector<LinearExpert>& linear,
                      std::vector<std::uint32_t>* averaged, TrainReport& report) {
    PerMesh kept;
    std::vector<CascadePrediction> predictions;
    double last_loss = std::numeric_limits<double>::infinity();
    const std::uint64_t first_seed = cascade.task.seed;
    for (std::size_t stage = 0; stage < cascade.max_cascade_stages; ++stage) {
        if (stage > 0) cascade.columns.begin_stage(kept);
        cascade.task.features = cascade.columns.count();
        cascade.task.seed = first_seed + stage;
        FoldBoostingResult result = stage == 0 && cascade.first
                                        ? std::move(*cascade.first)
                                        : run_stage(fmt::format("{} {}", cascade.name, stage), cascade.items,
                                                    cascade.task, options, scorer, report);
        if (stage > 0 && !(result.loss < cascade.max_loss_ratio * last_loss)) {
            report.stages.back().kept = false;
            break;
        }
        last_loss = result.loss;
        kept = std::move(result.out_of_fold);
        if (averaged && stage == 0) {
            *averaged = result.single_fold_labels;
            predictions.assign(kept.size(), CascadePrediction(*averaged, cascade.task.classes));
        }
        for (std::size_t m = 0; m < predictions.size(); ++m) predictions[m].add_stage(kept[m]);
        classifiers.push_back(std::move(result.classifier));
        linear.push_back(std::move(result.linear));
    }
    return kept;
}

}  // namespace exemplar
