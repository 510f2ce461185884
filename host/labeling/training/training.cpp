#include "host/labeling/training/training.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/progress.h"
#include "host/core/random.h"
#include "host/core/stopwatch.h"
#include "host/data/result_cache.h"
#include "host/labeling/features/edge_context.h"
#include "host/labeling/inference/mesh_turn.h"
#include "host/labeling/training/cascade_training.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_folds = 5;        ///< one in five held out: the thesis' 4 : 1
constexpr std::size_t k_patches = 25;         ///< of a single training mesh, dealt to the folds
constexpr std::size_t k_pairwise_stages = 2;  ///< base features, then with the contextual ones (App. A.2e)
/// A stage is kept if its out-of-fold loss is below this factor times that of the stage before it. A unary stage may
/// be slightly worse: with few meshes the classifiers of the folds learn less from the context, which differs from
/// mesh to mesh, than the classifier of all meshes.
constexpr double k_max_unary_loss_ratio = 1.05, k_max_pairwise_loss_ratio = 1;
/// Coordinates are kept if the out-of-fold loss is below this factor times that without them.
constexpr double k_max_oriented_loss_ratio = 0.9;
constexpr std::size_t k_min_oriented_meshes = 3;  ///< to tell that they are oriented alike
constexpr float k_sliver = 0.02F;                 ///< share of a label's largest piece in the mesh
constexpr std::size_t k_no_mesh = static_cast<std::size_t>(-1);
constexpr std::uint64_t k_unary_task = 1000, k_pairwise_task = 2000, k_fold_task = 1;

void require_trainable(const LabeledCorpus& corpus, std::size_t feature_sets) {
    if (corpus.meshes.empty()) throw DataError("there are no training meshes");
    if (feature_sets != corpus.meshes.size()) throw UsageError("features and training meshes differ in number");
    if (corpus.names.size() < 2)
        throw DataError("the training meshes have fewer than two labels: there is nothing to learn");
    if (corpus.names.size() > k_max_classes)
        throw DataError(fmt::format("the training meshes have {} labels, {} at most are supported", corpus.names.size(),
                                    k_max_classes));
}

/// Returns the fold of each face: that of its patch, the nearest of the first samples, in faces along the dual graph.
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

Folds make_folds(const LabeledCorpus& corpus, TrainingFeatures& features, std::uint64_t seed, TrainReport& report) {
    const std::size_t meshes = corpus.meshes.size();
    Folds folds;
    if (meshes == 1) {
        const MeshFeatures& mesh = features.at(0);
        folds.count = std::clamp<std::size_t>(mesh.context.sample_face.size(), 1, k_max_folds);
        folds.of_face = {patches_as_folds(mesh, folds.count)};
        report.folds.assign(folds.count, {corpus.meshes[0].name + " (patches)"});
        return folds;
    }
    folds.count = std::min(meshes, k_max_folds);
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

/// Scales weights to a sum of 1, so that every mesh counts the same, however large or finely meshed it is.
std::vector<float> normalized(std::vector<float> weight) {
    const double total = std::accumulate(weight.begin(), weight.end(), 0.0);
    if (total > 0)
        for (float& w : weight) w = static_cast<float>(w / total);
    return weight;
}

/// Weights each label by the square root of its area instead of its area. With areas, boosting would give up small
/// parts and labels that few meshes have, as many stumps are needed to separate them from the large ones.
void favor_rare_labels(const LabeledCorpus& corpus, std::vector<std::vector<float>>& weights) {
    std::vector<double> total(corpus.names.size(), 0);
    for (std::size_t m = 0; m < weights.size(); ++m)
        for (std::size_t f = 0; f < weights[m].size(); ++f)
            if (const std::int32_t label = corpus.meshes[m].label[f]; label >= 0)
                total[static_cast<std::size_t>(label)] += static_cast<double>(weights[m][f]);
    for (std::size_t m = 0; m < weights.size(); ++m)
        for (std::size_t f = 0; f < weights[m].size(); ++f)
            if (const std::int32_t label = corpus.meshes[m].label[f]; label >= 0 && weights[m][f] > 0)
                weights[m][f] /= static_cast<float>(std::sqrt(total[static_cast<std::size_t>(label)]));
}

/// Trains the first unary stage without and with the coordinates of the face centers (App. A.1h), and keeps the better
/// one, or what the options ask for. The meshes of a fold take part as they lie, so the held-out loss tells whether all
/// lie alike.
void train_first_stage(Cascade& cascade, const TrainOptions& options, StumpScorer& scorer, LabelingModel& model,
                       TrainReport& report) {
    const bool can_judge = cascade.items.size() >= k_min_oriented_meshes;
    const auto run = [&](const char* what) {
        cascade.task.features = cascade.columns.count();
        return run_stage(what, cascade.items, cascade.task, options, scorer, report);
    };
    cascade.first = run("unary 0");
    if (options.orientation == OrientationUse::never ||
        (options.orientation == OrientationUse::automatic && !can_judge))
        return;
    const std::vector<std::string> coordinates = orientation_names();
    cascade.columns.base += coordinates.size();
    FoldBoostingResult oriented = run("unary 0, xyz");
    if (options.orientation == OrientationUse::always ||
        oriented.loss < k_max_oriented_loss_ratio * cascade.first->loss) {
        report.stages.front().kept = false;
        model.unoriented = std::move(cascade.first->classifier);
        model.unoriented_linear = std::move(cascade.first->linear);
        cascade.first = std::move(oriented);
        model.unary_names.insert(model.unary_names.end(), coordinates.begin(), coordinates.end());
    } else {
        report.stages.back().kept = false;
        cascade.columns.base = cascade.columns.of_mesh;
    }
}

/// Trains the unary cascade; returns the out-of-fold probabilities of its last kept stage.
PerMesh train_unary(const LabeledCorpus& corpus, TrainingFeatures& features, const Folds& folds,
                    const TrainOptions& options, const LabelingBackend& backend, LabelingModel& model,
                    TrainReport& report) {
    const std::size_t classes = corpus.names.size();
    const std::vector<std::string> context = context_names(corpus.names);
    std::vector<std::vector<float>> weights;
    weights.reserve(features.count());
    for (std::size_t m = 0; m < features.count(); ++m) weights.push_back(normalized(features.outline(m).face_area));
    favor_rare_labels(corpus, weights);

    CascadeColumns columns{features, &MeshFeatures::unary, model.unary_names.size()};
    columns.context = context.size();
    columns.add_context = [&](MeshFeatures& mesh, std::span<const float> probabilities) {
        backend.context.accumulate(mesh.context, probabilities, classes,
                                   context_columns(mesh.unary, columns.base, context));
    };
    Cascade cascade{"unary", options.max_stages, k_max_unary_loss_ratio, {}, columns};
    cascade.task.classes = classes;
    cascade.task.linear = options.linear;
    cascade.task.patience = 0;  // the error keeps falling when the loss rises: see docs/labeling.md
    cascade.task.folds = folds.count;
    cascade.task.seed = options.seed + k_unary_task;
    for (std::size_t m = 0; m < features.count(); ++m)
        cascade.add_items(corpus.meshes[m].label, weights[m], folds.of_face[m]);
    train_first_stage(cascade, options, backend.scorer, model, report);
    return train_cascade(std::move(cascade), options, backend.scorer, model.unary, model.linear, &model.averaged_labels,
                         report);
}

/// Training data of the boundary classifiers: per mesh and edge 0 = same label, 1 = boundary, -1 = unknown, and a
/// weight that balances the few boundary edges against the many others (thesis Sec. 3.3.1).
struct EdgeTargets {
    std::vector<std::vector<std::int32_t>> label;
    std::vector<std::vector<float>> weight;
    std::vector<std::vector<std::uint8_t>> fold;
    bool both = false;  ///< whether both boundaries and other edges occur
};

EdgeTargets make_edge_targets(const LabeledCorpus& corpus, const TrainingFeatures& features, const Folds& folds) {
    EdgeTargets targets;
    std::array<double, 2> count{0, 0};
    for (std::size_t m = 0; m < features.count(); ++m) {
        const std::vector<std::int32_t>& face_label = corpus.meshes[m].label;
        std::vector<std::int32_t> label;
        std::vector<std::uint8_t> fold;
        for (const auto& [a, b] : features.outline(m).edges) {
            const bool known = face_label[a] >= 0 && face_label[b] >= 0;
            label.push_back(known ? static_cast<std::int32_t>(face_label[a] != face_label[b]) : -1);
            fold.push_back(folds.of_face[m][a]);
            if (known) ++count[label.back()];
        }
        targets.label.push_back(std::move(label));
        targets.fold.push_back(std::move(fold));
        targets.weight.push_back(normalized(features.outline(m).edge_length));
    }
    targets.both = count[0] > 0 && count[1] > 0;
    const double total = std::max(count[0] + count[1], 1.0);
    for (std::size_t m = 0; m < features.count(); ++m)
        for (std::size_t e = 0; e < targets.label[m].size(); ++e)
            if (const std::int32_t label = targets.label[m][e]; label >= 0)
                targets.weight[m][e] *= static_cast<float>(count[1 - label] / total);
    return targets;
}

/// Trains the boundary classifiers; returns the out-of-fold boundary probability per edge. If the parts of all meshes
/// are separate pieces, or the options ask for none, the model gets no classifier, and all probabilities are
/// k_unknown_boundary_probability.
PerMesh train_pairwise(const LabeledCorpus& corpus, TrainingFeatures& features, const Folds& folds,
                       const TrainOptions& options, const LabelingBackend& backend, LabelingModel& model,
                       TrainReport& report) {
    const EdgeTargets targets = make_edge_targets(corpus, features, folds);
    if (!targets.both || !options.boundary) {
        PerMesh even;
        for (std::size_t m = 0; m < features.count(); ++m)
            even.emplace_back(features.outline(m).edges.size(), k_unknown_boundary_probability);
        return even;
    }
    const std::vector<std::string> context = edge_context_names();
    CascadeColumns columns{features, &MeshFeatures::pairwise, model.pairwise_names.size()};
    columns.context = context.size();
    columns.add_context = [&](MeshFeatures& mesh, std::span<const float> probabilities) {
        accumulate_edge_context(mesh, boundary_column(probabilities),
                                context_columns(mesh.pairwise, columns.base, context));
    };
    Cascade cascade{"pairwise", k_pairwise_stages, k_max_pairwise_loss_ratio, {}, columns};
    cascade.task.binary = true;
    cascade.task.patience = options.patience;
    cascade.task.folds = folds.count;
    cascade.task.seed = options.seed + k_pairwise_task;
    for (std::size_t m = 0; m < features.count(); ++m)
        cascade.add_items(targets.label[m], targets.weight[m], targets.fold[m]);
    std::vector<LinearExpert> none;
    PerMesh boundary =
        train_cascade(std::move(cascade), options, backend.scorer, model.pairwise, none, nullptr, report);
    for (std::vector<float>& probabilities : boundary) probabilities = boundary_column(probabilities);
    return boundary;
}

/// Returns the area share of the smallest connected piece of each label in one mesh; 0 for labels that do not occur.
/// Ignores slivers, far smaller than a label's largest piece: they are annotation errors.
std::vector<float> smallest_pieces(const MeshFeatures& features, std::span<const std::int32_t> labels,
                                   std::size_t classes) {
    const LabelComponents pieces = label_components(features.edges, features.face_area, labels);
    std::vector<float> largest(classes, 0), smallest(classes, 0);
    for (std::size_t p = 0; p < pieces.label.size(); ++p)
        if (pieces.label[p] >= 0) largest[pieces.label[p]] = std::max(largest[pieces.label[p]], pieces.area_share[p]);
    for (std::size_t p = 0; p < pieces.label.size(); ++p) {
        const std::int32_t label = pieces.label[p];
        if (label < 0 || pieces.area_share[p] < k_sliver * largest[label]) continue;
        if (smallest[label] == 0 || pieces.area_share[p] < smallest[label]) smallest[label] = pieces.area_share[p];
    }
    return smallest;
}

/// Returns the smallest piece per label over all meshes except `left_out`.
std::vector<float> smallest_of_others(const PerMesh& of_mesh, std::size_t left_out) {
    std::vector<float> smallest(of_mesh.front().size(), 0);
    for (std::size_t m = 0; m < of_mesh.size(); ++m)
        for (std::size_t c = 0; c < smallest.size() && m != left_out; ++c)
            if (of_mesh[m][c] > 0 && (smallest[c] == 0 || of_mesh[m][c] < smallest[c])) smallest[c] = of_mesh[m][c];
    return smallest;
}

std::vector<bool> touching_labels(const LabeledCorpus& corpus, const TrainingFeatures& features) {
    const std::size_t classes = corpus.names.size();
    std::vector<bool> touching(classes * classes, false);
    for (std::size_t m = 0; m < features.count(); ++m)
        for (const auto& [a, b] : features.outline(m).edges) {
            const std::int32_t x = corpus.meshes[m].label[a], y = corpus.meshes[m].label[b];
            if (x >= 0 && y >= 0 && x != y) touching[x * classes + y] = touching[y * classes + x] = true;
        }
    return touching;
}

/// Returns the labels that out-of-fold probabilities can be compared with: -1 where no other fold has a face of the
/// label.
std::vector<std::vector<std::int32_t>> learnable_labels(const LabeledCorpus& corpus, const Folds& folds) {
    const std::size_t classes = corpus.names.size();
    std::vector<std::vector<bool>> occurs(classes, std::vector<bool>(folds.count, false));  // per label and fold
    for (std::size_t m = 0; m < corpus.meshes.size(); ++m)
        for (std::size_t f = 0; f < folds.of_face[m].size(); ++f)
            if (const std::int32_t label = corpus.meshes[m].label[f]; label >= 0)
                occurs[static_cast<std::size_t>(label)][folds.of_face[m][f]] = true;
    std::vector<std::vector<std::int32_t>> learnable;
    for (std::size_t m = 0; m < corpus.meshes.size(); ++m) {
        learnable.push_back(corpus.meshes[m].label);
        for (std::int32_t& label : learnable.back())
            if (label >= 0 && std::ranges::count(occurs[static_cast<std::size_t>(label)], true) < 2) label = -1;
    }
    return learnable;
}

void train_crf(const LabeledCorpus& corpus, const TrainingFeatures& features, const Folds& folds,
               const PerMesh& probabilities, const PerMesh& boundary, LabelingModel& model, TrainReport& report) {
    const std::size_t classes = corpus.names.size();
    PerMesh smallest;
    for (std::size_t m = 0; m < features.count(); ++m)
        smallest.push_back(smallest_pieces(features.outline(m), corpus.meshes[m].label, classes));
    model.smallest_component = smallest_of_others(smallest, k_no_mesh);

    const std::vector<std::vector<std::int32_t>> truth = learnable_labels(corpus, folds);
    std::vector<CrfExample> examples;
    for (std::size_t m = 0; m < features.count(); ++m)
        examples.push_back({&features.outline(m),
                            make_crf_terms(features.outline(m), probabilities[m], classes, boundary[m]), truth[m],
                            smallest_of_others(smallest, features.count() > 1 ? m : k_no_mesh)});
    const std::vector<bool> touching = touching_labels(corpus, features);
    Progress progress("searching CRF parameters", crf_search_evaluations(classes, touching));
    const Stopwatch watch;
    model.crf = learn_crf(
        examples, classes, touching, [&] { progress.advance(); }, report.crf);
    report.crf_seconds = watch.wall();
}

}  // namespace

std::vector<std::string> orientation_uses() {
    return {"auto", "yes", "no"};
}

OrientationUse orientation_use(const std::string& name) {
    const std::vector<std::string> names = orientation_uses();
    const auto found = std::ranges::find(names, name);
    if (found == names.end())
        throw UsageError(fmt::format("orientation is {}, not {}", fmt::join(names, ", "), name.substr(0, 40)));
    return static_cast<OrientationUse>(found - names.begin());
}

LabelingModel train_labeling(const LabeledCorpus& corpus, std::vector<MeshFeatures>& features,
                             const TrainOptions& options, const LabelingBackend& backend, TrainReport& report) {
    TrainingFeatures in_memory(features);
    return train_labeling(corpus, in_memory, options, backend, report);
}

LabelingModel train_labeling(const LabeledCorpus& corpus, TrainingFeatures& features, const TrainOptions& options,
                             const LabelingBackend& backend, TrainReport& report) {
    require_trainable(corpus, features.count());
    report = {};
    features.drop_appended();
    LabelingModel model;
    model.label_names = corpus.names;
    for (std::size_t c = 0; c < corpus.names.size(); ++c) model.label_colors.push_back(label_color(c));
    model.feature_options = options.features;
    model.unary_names = features.at(0).unary.names;
    model.pairwise_names = features.at(0).pairwise.names;
    model.seed = options.seed;
    for (const LabeledMesh& mesh : corpus.meshes) model.provenance.push_back(mesh.name + " " + content_hash(mesh.mesh));

    const Folds folds = make_folds(corpus, features, options.seed, report);
    const PerMesh probabilities = train_unary(corpus, features, folds, options, backend, model, report);
    const PerMesh boundary = train_pairwise(corpus, features, folds, options, backend, model, report);
    train_crf(corpus, features, folds, probabilities, boundary, model, report);
    return model;
}

}  // namespace exemplar
