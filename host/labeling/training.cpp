#include "host/labeling/training.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/core/random.h"
#include "host/core/stopwatch.h"
#include "host/labeling/edge_context.h"
#include "host/labeling/feature_cache.h"
#include "host/labeling/fold_boosting.h"

namespace exemplar {
namespace {

constexpr std::size_t k_most_folds = 5;       ///< one in five held out: the thesis' 4 : 1
constexpr std::size_t k_patches = 25;         ///< of a single training mesh, dealt to the folds
constexpr std::size_t k_pairwise_stages = 2;  ///< base features, then with the contextual ones (App. A.2e)
constexpr std::uint64_t k_unary_task = 1000, k_pairwise_task = 2000, k_fold_task = 1;

using PerMesh = std::vector<std::vector<float>>;

void require_trainable(const LabeledCorpus& corpus, std::size_t feature_sets) {
    if (corpus.meshes.empty()) throw DataError("there are no training meshes");
    if (feature_sets != corpus.meshes.size()) throw UsageError("features and training meshes differ in number");
    if (corpus.names.size() < 2)
        throw DataError("the training meshes have fewer than two labels: there is nothing to learn");
    if (corpus.names.size() > k_max_classes)
        throw DataError(fmt::format("the training meshes have {} labels, {} at most are supported", corpus.names.size(),
                                    k_max_classes));
}

/// Patch of each face: the nearest of the first samples, counted in faces along the dual graph.
std::vector<std::uint8_t> patches_as_folds(const MeshFeatures& features, std::size_t folds) {
    std::vector<std::vector<std::uint32_t>> neighbors(features.face_area.size());
    for (const auto& [a, b] : features.edges) neighbors[a].push_back(b), neighbors[b].push_back(a);
    std::vector<std::uint8_t> fold(features.face_area.size(), 0);
    std::vector<bool> seen(fold.size(), false);
    std::deque<std::uint32_t> queue;
    for (std::size_t s = 0; s < std::min(k_patches, features.context.sample_face.size()); ++s) {
        const std::uint32_t face = features.context.sample_face[s];
        fold[face] = static_cast<std::uint8_t>(s % folds);
        seen[face] = true;
        queue.push_back(face);
    }
    while (!queue.empty()) {
        const std::uint32_t face = queue.front();
        queue.pop_front();
        for (const std::uint32_t other : neighbors[face]) {
            if (seen[other]) continue;
            seen[other] = true;
            fold[other] = fold[face];
            queue.push_back(other);
        }
    }
    return fold;
}

struct Folds {
    std::size_t count = 1;
    std::vector<std::vector<std::uint8_t>> of_face;  ///< per mesh
};

Folds make_folds(const LabeledCorpus& corpus, const std::vector<MeshFeatures>& features, std::uint64_t seed,
                 TrainReport& report) {
    const std::size_t meshes = corpus.meshes.size();
    Folds folds;
    if (meshes == 1) {
        folds.count = std::clamp<std::size_t>(features[0].context.sample_face.size(), 1, k_most_folds);
        folds.of_face = {patches_as_folds(features[0], folds.count)};
        report.folds.assign(folds.count, {corpus.meshes[0].name + " (patches)"});
        return folds;
    }
    folds.count = std::min(meshes, k_most_folds);
    std::vector<std::size_t> order(meshes);
    std::iota(order.begin(), order.end(), std::size_t{0});
    Random(seed).fork(k_fold_task).shuffle(order);
    folds.of_face.resize(meshes);
    report.folds.resize(folds.count);
    for (std::size_t i = 0; i < meshes; ++i) {
        const std::size_t fold = i % folds.count;
        folds.of_face[order[i]].assign(corpus.meshes[order[i]].label.size(), static_cast<std::uint8_t>(fold));
        report.folds[fold].push_back(corpus.meshes[order[i]].name);
    }
    return folds;
}

/// Scales weights so that every mesh counts the same, however large or finely meshed it is.
std::vector<float> normalized(std::vector<float> weight) {
    const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
    if (total > 0)
        for (float& w : weight) w = static_cast<float>(w / total);
    return weight;
}

/// One boosting task over all meshes, with its progress and its row of the report.
FoldBoostingResult run_stage(const std::string& what, std::span<const BoostingItems> items, FoldBoostingOptions options,
                             const TrainOptions& train, StumpScorer& scorer, TrainReport& report) {
    options.rounds = train.rounds, options.patience = train.patience, options.bins = train.bins;
    options.rows_per_mesh = train.rows_per_mesh;
    Progress progress("training " + what + " (rounds)", (options.folds + 1) * options.rounds);
    const Stopwatch watch;
    FoldBoostingResult result = boost_with_folds(items, options, scorer, [&] { progress.advance(); });
    progress.finish();
    report.stages.push_back(
        {what, result.classifier.stumps.stumps.size(), result.loss, result.error, true, result.curve, watch.wall()});
    return result;
}

/// Trains the unary cascade; returns the out-of-fold probabilities of its last kept stage.
PerMesh train_unary(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features, const Folds& folds,
                    const TrainOptions& options, const LabelingBackend& backend, LabelingModel& model,
                    TrainReport& report) {
    const std::size_t base = model.unary_names.size();
    const std::vector<std::string> context = context_names(corpus.names);
    std::vector<std::vector<float>> weights;
    for (const MeshFeatures& mesh : features) weights.push_back(normalized(mesh.face_area));

    PerMesh kept;
    double best_loss = 1e30;
    for (std::size_t stage = 0; stage < options.max_stages; ++stage) {
        std::vector<BoostingItems> items;
        for (std::size_t m = 0; m < features.size(); ++m) {
            if (stage > 0)
                backend.context.accumulate(features[m].context, kept[m], corpus.names.size(),
                                           context_columns(features[m].unary, base, context));
            items.push_back({&features[m].unary, corpus.meshes[m].label, weights[m], folds.of_face[m]});
        }
        FoldBoostingOptions task;
        task.classes = corpus.names.size();
        task.features = base + (stage > 0 ? context.size() : 0);
        task.folds = folds.count;
        task.seed = options.seed + k_unary_task + stage;
        FoldBoostingResult result =
            run_stage(fmt::format("unary {}", stage), items, task, options, backend.scorer, report);
        if (stage > 0 && result.loss >= best_loss) {
            report.stages.back().kept = false;
            break;
        }
        best_loss = result.loss;
        kept = std::move(result.out_of_fold);
        model.unary.push_back(std::move(result.classifier));
    }
    return kept;
}

/// What the boundary classifiers learn from: per mesh and edge 0 = same label, 1 = boundary, -1 = unknown, and a weight
/// that balances the few boundary edges against the many others (thesis Sec. 3.3.1).
struct EdgeTargets {
    std::vector<std::vector<std::int32_t>> label;
    std::vector<std::vector<float>> weight;
    std::vector<std::vector<std::uint8_t>> fold;
};

EdgeTargets make_edge_targets(const LabeledCorpus& corpus, const std::vector<MeshFeatures>& features,
                              const Folds& folds) {
    EdgeTargets targets;
    std::array<double, 2> count{0, 0};
    for (std::size_t m = 0; m < features.size(); ++m) {
        const std::vector<std::int32_t>& face_label = corpus.meshes[m].label;
        std::vector<std::int32_t> label;
        std::vector<std::uint8_t> fold;
        for (const auto& [a, b] : features[m].edges) {
            const bool known = face_label[a] >= 0 && face_label[b] >= 0;
            label.push_back(known ? static_cast<std::int32_t>(face_label[a] != face_label[b]) : -1);
            fold.push_back(folds.of_face[m][a]);
            if (known) ++count[label.back()];
        }
        targets.label.push_back(std::move(label));
        targets.fold.push_back(std::move(fold));
        targets.weight.push_back(normalized(features[m].edge_length));
    }
    const double total = std::max(count[0] + count[1], 1.0);
    for (std::size_t m = 0; m < features.size(); ++m)
        for (std::size_t e = 0; e < targets.label[m].size(); ++e)
            if (const std::int32_t label = targets.label[m][e]; label >= 0)
                targets.weight[m][e] *= static_cast<float>(count[1 - label] / total);
    return targets;
}

/// Trains the boundary classifiers; returns the out-of-fold boundary probability per edge.
PerMesh train_pairwise(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features, const Folds& folds,
                       const TrainOptions& options, const LabelingBackend& backend, LabelingModel& model,
                       TrainReport& report) {
    const std::size_t base = model.pairwise_names.size();
    const EdgeTargets targets = make_edge_targets(corpus, features, folds);
    PerMesh boundary(features.size());
    double best_loss = 1e30;
    for (std::size_t stage = 0; stage < k_pairwise_stages; ++stage) {
        std::vector<BoostingItems> items;
        for (std::size_t m = 0; m < features.size(); ++m) {
            if (stage > 0)
                accumulate_edge_context(features[m], boundary[m],
                                        context_columns(features[m].pairwise, base, edge_context_names()));
            items.push_back({&features[m].pairwise, targets.label[m], targets.weight[m], targets.fold[m]});
        }
        FoldBoostingOptions task;
        task.classes = 2;
        task.binary = true;
        task.features = base + (stage > 0 ? EdgeNeighborhood::k_bins : 0);
        task.folds = folds.count;
        task.seed = options.seed + k_pairwise_task + stage;
        FoldBoostingResult result =
            run_stage(fmt::format("pairwise {}", stage), items, task, options, backend.scorer, report);
        if (stage > 0 && result.loss >= best_loss) {
            report.stages.back().kept = false;
            break;
        }
        best_loss = result.loss;
        for (std::size_t m = 0; m < features.size(); ++m) boundary[m] = boundary_column(result.out_of_fold[m]);
        model.pairwise.push_back(std::move(result.classifier));
    }
    return boundary;
}

/// Area share of the smallest connected piece of each label; 0 for labels that never occur.
std::vector<float> smallest_components(const LabeledCorpus& corpus, const std::vector<MeshFeatures>& features) {
    std::vector<float> smallest(corpus.names.size(), 0);
    for (std::size_t m = 0; m < features.size(); ++m) {
        const LabelComponents pieces = label_components(features[m], corpus.meshes[m].label);
        for (std::size_t p = 0; p < pieces.label.size(); ++p) {
            if (pieces.label[p] < 0) continue;
            float& least = smallest[pieces.label[p]];
            if (least == 0 || pieces.area_share[p] < least) least = pieces.area_share[p];
        }
    }
    return smallest;
}

std::vector<bool> touching_labels(const LabeledCorpus& corpus, const std::vector<MeshFeatures>& features) {
    const std::size_t classes = corpus.names.size();
    std::vector<bool> touching(classes * classes, false);
    for (std::size_t m = 0; m < features.size(); ++m)
        for (const auto& [a, b] : features[m].edges) {
            const std::int32_t x = corpus.meshes[m].label[a], y = corpus.meshes[m].label[b];
            if (x >= 0 && y >= 0 && x != y) touching[x * classes + y] = touching[y * classes + x] = true;
        }
    return touching;
}

void train_crf(const LabeledCorpus& corpus, const std::vector<MeshFeatures>& features, const PerMesh& probabilities,
               const PerMesh& boundary, LabelingModel& model, TrainReport& report) {
    const std::size_t classes = corpus.names.size();
    const std::vector<bool> touching = touching_labels(corpus, features);
    std::vector<CrfExample> examples;
    for (std::size_t m = 0; m < features.size(); ++m)
        examples.push_back({&features[m], make_crf_terms(features[m], probabilities[m], classes, boundary[m]),
                            corpus.meshes[m].label});
    Progress progress("searching CRF parameters", crf_search_evaluations(classes, touching));
    const Stopwatch watch;
    model.crf = learn_crf(
        examples, classes, touching, model.smallest_component, [&] { progress.advance(); }, report.crf);
    report.crf_seconds = watch.wall();
}

}  // namespace

LabelingModel train_labeling(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features,
                             const TrainOptions& options, const LabelingBackend& backend, TrainReport& report) {
    require_trainable(corpus, features.size());
    report = {};
    for (MeshFeatures& mesh : features) drop_context_columns(mesh);
    LabelingModel model;
    model.label_names = corpus.names;
    for (std::size_t c = 0; c < corpus.names.size(); ++c) model.label_colors.push_back(label_color(c));
    model.feature_options = options.features;
    model.unary_names = features.front().unary.names;
    model.pairwise_names = features.front().pairwise.names;
    model.seed = options.seed;
    for (const LabeledMesh& mesh : corpus.meshes) model.provenance.push_back(mesh.name + " " + content_hash(mesh.mesh));
    model.smallest_component = smallest_components(corpus, features);

    const Folds folds = make_folds(corpus, features, options.seed, report);
    const PerMesh probabilities = train_unary(corpus, features, folds, options, backend, model, report);
    const PerMesh boundary = train_pairwise(corpus, features, folds, options, backend, model, report);
    train_crf(corpus, features, probabilities, boundary, model, report);
    return model;
}

}  // namespace exemplar
