#include "host/labeling/inference/labeler.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <iterator>
#include <numbers>
#include <utility>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/labeling/features/edge_context.h"
#include "host/labeling/inference/cascade_prediction.h"
#include "host/labeling/inference/crf.h"
#include "host/labeling/inference/mesh_turn.h"

namespace exemplar {
namespace {

void require_features(const FeatureMatrix& matrix, const std::vector<std::string>& names, const char* what) {
    if (matrix.cols() >= names.size() && std::equal(names.begin(), names.end(), matrix.names.begin())) return;
    throw ModelError(fmt::format("the model was trained on other {} features ({} instead of {}); train it again", what,
                                 names.size(), matrix.cols()));
}

using Meshes = std::span<MeshFeatures* const>;
/// Probabilities of each mesh.
using Scores = std::vector<std::vector<float>>;

/// Scores one stage of a cascade for all meshes together. The model guarantees that stage 0 uses no contextual
/// columns.
Scores score(const CalibratedStumps& stage, Meshes meshes, FeatureMatrix MeshFeatures::*matrix, StumpScorer& scorer) {
    Scores scores;
    scores.reserve(meshes.size());
    std::vector<ScoredMatrix> scored;
    for (const MeshFeatures* mesh : meshes) {
        const FeatureMatrix& features = mesh->*matrix;
        scores.emplace_back(features.rows * stage.stumps.class_count);
        scored.push_back({&features, scores.back()});
    }
    scorer.probabilities_of_all(stage.stumps, stage.link, stage.scale, scored);
    return scores;
}

/// Scores one stage of the unary cascade, combined with its linear classifier.
Scores score_unary_stage(const LabelingModel& model, std::size_t stage, Meshes meshes, StumpScorer& scorer) {
    Scores scores = score(model.unary[stage], meshes, &MeshFeatures::unary, scorer);
    if (stage < model.linear.size())
        for (std::size_t m = 0; m < meshes.size(); ++m)
            pool(model.linear[stage], meshes[m]->unary, model.averaged_labels, scores[m]);
    return scores;
}

/// Runs the unary cascade, stage by stage.
Scores score_unary(const LabelingModel& model, Meshes meshes, const LabelingBackend& backend) {
    Scores scores = score_unary_stage(model, 0, meshes, backend.scorer);
    std::vector<CascadePrediction> predictions(meshes.size(), {model.averaged_labels, model.class_count()});
    for (std::size_t m = 0; m < meshes.size(); ++m) predictions[m].add_stage(scores[m]);
    const std::vector<std::string> names = context_names(model.label_names);
    for (std::size_t stage = 1; stage < model.unary.size(); ++stage) {
        check_interrupt();
        std::vector<ContextMesh> contexts;
        for (std::size_t m = 0; m < meshes.size(); ++m)
            contexts.push_back(
                {&meshes[m]->context, scores[m], context_columns(meshes[m]->unary, model.unary_names.size(), names)});
        backend.context.accumulate_all(contexts, model.class_count());
        scores = score_unary_stage(model, stage, meshes, backend.scorer);
        for (std::size_t m = 0; m < meshes.size(); ++m) predictions[m].add_stage(scores[m]);
    }
    return scores;
}

/// P(boundary) of each mesh's edges.
Scores score_boundary(const LabelingModel& model, Meshes meshes, const LabelingBackend& backend) {
    Scores boundaries;
    if (model.pairwise.empty()) {
        for (const MeshFeatures* mesh : meshes)
            boundaries.emplace_back(mesh->edges.size(), k_unknown_boundary_probability);
        return boundaries;
    }
    const std::vector<std::string> names = edge_context_names();
    for (std::size_t stage = 0; stage < model.pairwise.size(); ++stage) {
        for (std::size_t m = 0; m < boundaries.size(); ++m)  // none before the first stage
            accumulate_edge_context(*meshes[m], boundaries[m],
                                    context_columns(meshes[m]->pairwise, model.pairwise_names.size(), names));
        boundaries = score(model.pairwise[stage], meshes, &MeshFeatures::pairwise, backend.scorer);
        for (std::vector<float>& boundary : boundaries) boundary = boundary_column(boundary);
    }
    return boundaries;
}

/// Runs all classifiers, one after the other.
std::vector<FaceScores> score_in_stages(const LabelingModel& model, Meshes meshes, const LabelingBackend& backend) {
    std::vector<FaceScores> scores(meshes.size());
    const Stopwatch watch;
    Scores unary = score_unary(model, meshes, backend);
    for (std::size_t m = 0; m < meshes.size(); ++m) scores[m].probabilities = std::move(unary[m]);
    const double unary_seconds = watch.wall();
    add_seconds("unary", unary_seconds, scores);
    Scores boundary = score_boundary(model, meshes, backend);
    for (std::size_t m = 0; m < meshes.size(); ++m) scores[m].boundary = std::move(boundary[m]);
    add_seconds("pairwise", watch.wall() - unary_seconds, scores);
    return scores;
}

/// Turns the meshes to lie like those of training if the model has coordinates. Returns the angles, in degrees.
std::vector<float> orient(const LabelingModel& model, Meshes meshes) {
    std::vector<float> turned(meshes.size(), 0);
    if (!uses_orientation(model)) return turned;
    const std::size_t base = model.unary_names.size() - orientation_names().size();
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        if (meshes[m]->unary.cols() >= base) set_orientation(*meshes[m], base, Eigen::Matrix3f::Identity());
        check_features(model, *meshes[m]);
        const Eigen::Matrix3f turn = likeliest_turn(model, *meshes[m]);
        set_orientation(*meshes[m], base, turn);
        turned[m] = Eigen::AngleAxisf(turn).angle() * 180 / std::numbers::pi_v<float>;
    }
    return turned;
}

/// The largest value of the edges of each face; 0 for a face without interior edges.
std::vector<float> largest_of_face(const MeshFeatures& features, std::span<const float> of_edge) {
    std::vector<float> largest(features.face_area.size(), 0);
    for (std::size_t e = 0; e < features.edges.size(); ++e)
        for (const std::uint32_t f : features.edges[e]) largest[f] = std::max(largest[f], of_edge[e]);
    return largest;
}

/// Runs all classifiers, on the device where the meshes fit.
std::vector<FaceScores> score_oriented(const LabelingModel& model, Meshes meshes, const LabelingBackend& backend) {
    if (!backend.cascade) return score_in_stages(model, meshes, backend);
    std::vector<FaceScores> scores;
    while (!meshes.empty()) {
        check_interrupt();
        std::size_t count = backend.cascade->fitting(model, meshes);
        const bool fits = count > 0;
        while (!fits && ++count < meshes.size() && backend.cascade->fitting(model, meshes.subspan(count)) == 0) {
        }
        std::vector<FaceScores> some = fits ? backend.cascade->score(model, meshes.first(count))
                                            : score_in_stages(model, meshes.first(count), backend);
        meshes = meshes.subspan(some.size());
        std::ranges::move(some, std::back_inserter(scores));
    }
    return scores;
}

}  // namespace

std::vector<std::string> edge_context_names() {
    std::vector<std::string> names;
    for (std::size_t bin = 0; bin < EdgeNeighborhood::k_bins; ++bin)
        names.push_back(fmt::format("context.boundary.{}", bin));
    return names;
}

std::vector<float> boundary_column(std::span<const float> probabilities) {
    std::vector<float> boundary(probabilities.size() / 2);
    for (std::size_t e = 0; e < boundary.size(); ++e) boundary[e] = probabilities[2 * e + 1];
    return boundary;
}

std::vector<std::string> context_names(const std::vector<std::string>& label_names) {
    constexpr std::array<const char*, k_context_measures> k_measures{
        "geodesic", "principal0", "principal1", "principal2", "symmetry0", "symmetry1", "symmetry2"};
    std::vector<std::string> names;
    for (const char* measure : k_measures)
        for (std::size_t bin = 0; bin < k_context_bins; ++bin)
            for (const std::string& label : label_names)
                names.push_back(fmt::format("context.{}.{}.{}", measure, bin, label));
    return names;
}

std::span<float> context_columns(FeatureMatrix& matrix, std::size_t base, const std::vector<std::string>& names) {
    matrix.names.resize(base);
    matrix.names.insert(matrix.names.end(), names.begin(), names.end());
    matrix.values.resize(matrix.cols() * matrix.rows);
    return std::span<float>(matrix.values).subspan(base * matrix.rows, names.size() * matrix.rows);
}

void drop_context_columns(MeshFeatures& features) {
    for (FeatureMatrix* matrix : {&features.unary, &features.pairwise}) {
        matrix->names.erase(std::ranges::find_if(matrix->names, is_appended), matrix->names.end());
        matrix->values.resize(matrix->cols() * matrix->rows);
    }
}

void check_features(const LabelingModel& model, const MeshFeatures& features) {
    require_features(features.unary, model.unary_names, "face");
    if (!model.pairwise.empty()) require_features(features.pairwise, model.pairwise_names, "edge");
}

void add_seconds(const char* stage, double seconds, std::span<FaceScores> scores) {
    std::size_t all = 0;
    for (const FaceScores& mesh : scores) all += mesh.probabilities.size();
    for (FaceScores& mesh : scores) {
        const double share =
            static_cast<double>(mesh.probabilities.size()) / static_cast<double>(std::max<std::size_t>(all, 1));
        mesh.seconds.emplace_back(stage, seconds * share);
    }
}

std::vector<FaceScores> score_faces(const LabelingModel& model, std::span<MeshFeatures* const> meshes,
                                    const LabelingBackend& backend) {
    const Stopwatch watch;
    const std::vector<float> turned = orient(model, meshes);
    const double seconds = watch.wall();
    for (const MeshFeatures* mesh : meshes) check_features(model, *mesh);
    std::vector<FaceScores> scores = score_oriented(model, meshes, backend);
    for (std::size_t m = 0; m < scores.size(); ++m) {
        scores[m].turned = turned[m];
        scores[m].seconds.front().second += seconds / static_cast<double>(scores.size());  // of the unary cascade
    }
    return scores;
}

FaceLabeling cut_faces(const LabelingModel& model, const MeshFeatures& features, FaceScores scores) {
    check_interrupt();
    const Stopwatch watch;
    const std::size_t classes = model.class_count();
    FaceLabeling result;
    result.probabilities = std::move(scores.probabilities);
    result.seconds = std::move(scores.seconds);
    result.turned = scores.turned;
    const CrfTerms terms = make_crf_terms(features, result.probabilities, classes, scores.boundary);
    result.label = solve_crf(features, terms, model.crf);
    merge_small_components(features, model.crf, model.smallest_component, result.label);
    result.confidence.reserve(result.label.size());
    for (std::size_t f = 0; f < result.label.size(); ++f)
        result.confidence.push_back(result.probabilities[f * classes + result.label[f]]);
    if (!model.pairwise.empty()) result.border = largest_of_face(features, scores.boundary);
    result.seconds.emplace_back("cut", watch.wall());
    return result;
}

FaceLabeling label_faces(const LabelingModel& model, MeshFeatures& features, const LabelingBackend& backend) {
    MeshFeatures* const mesh = &features;
    return cut_faces(model, features, std::move(score_faces(model, std::span(&mesh, 1), backend).front()));
}

}  // namespace exemplar
