#include "host/labeling/labeler.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/stopwatch.h"
#include "host/labeling/cascade_opinion.h"
#include "host/labeling/crf.h"
#include "host/labeling/edge_context.h"

namespace exemplar {
namespace {

void require_features(const FeatureMatrix& matrix, const std::vector<std::string>& names, const char* what) {
    if (matrix.cols() >= names.size() && std::equal(names.begin(), names.end(), matrix.names.begin())) return;
    throw ModelError(fmt::format("the model was trained on other {} features ({} instead of {}); train it again", what,
                                 names.size(), matrix.cols()));
}

/// Scores one stage of a cascade; stage 0 must not see contextual columns, which the model guarantees.
std::vector<float> score(const CalibratedStumps& stage, const FeatureMatrix& matrix, StumpScorer& scorer) {
    std::vector<float> out(matrix.rows * stage.stumps.class_count);
    scorer.probabilities(stage.stumps, matrix, stage.link, stage.scale, out);
    return out;
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
        const auto is_context = [](const std::string& name) { return name.starts_with("context."); };
        matrix->names.erase(std::find_if(matrix->names.begin(), matrix->names.end(), is_context), matrix->names.end());
        matrix->values.resize(matrix->cols() * matrix->rows);
    }
}

std::vector<float> unary_probabilities(const LabelingModel& model, MeshFeatures& features,
                                       const LabelingBackend& backend) {
    require_features(features.unary, model.unary_names, "face");
    std::vector<float> probabilities = score(model.unary.front(), features.unary, backend.scorer);
    CascadeOpinion opinion(model.averaged_labels, model.class_count());
    opinion.add_stage(probabilities);
    const std::vector<std::string> names = context_names(model.label_names);
    for (std::size_t stage = 1; stage < model.unary.size(); ++stage) {
        check_interrupt();
        const std::span<float> context = context_columns(features.unary, model.unary_names.size(), names);
        backend.context.accumulate(features.context, probabilities, model.class_count(), context);
        probabilities = score(model.unary[stage], features.unary, backend.scorer);
        opinion.add_stage(probabilities);
    }
    return probabilities;
}

std::vector<float> boundary_probabilities(const LabelingModel& model, MeshFeatures& features,
                                          const LabelingBackend& backend) {
    if (model.pairwise.empty()) return std::vector<float>(features.edges.size(), k_even_odds);
    require_features(features.pairwise, model.pairwise_names, "edge");
    std::vector<float> boundary = boundary_column(score(model.pairwise.front(), features.pairwise, backend.scorer));
    for (std::size_t stage = 1; stage < model.pairwise.size(); ++stage) {
        const std::span<float> context =
            context_columns(features.pairwise, model.pairwise_names.size(), edge_context_names());
        accumulate_edge_context(features, boundary, context);
        boundary = boundary_column(score(model.pairwise[stage], features.pairwise, backend.scorer));
    }
    return boundary;
}

FaceLabeling label_faces(const LabelingModel& model, MeshFeatures& features, const LabelingBackend& backend) {
    FaceLabeling result;
    Stopwatch watch;
    double before = 0;
    const auto lap = [&](const char* stage) {
        result.seconds.emplace_back(stage, watch.wall() - before);
        before = watch.wall();
    };
    result.probabilities = unary_probabilities(model, features, backend);
    lap("unary");
    const std::vector<float> boundary = boundary_probabilities(model, features, backend);
    lap("pairwise");
    check_interrupt();
    const std::size_t classes = model.class_count();
    const CrfTerms terms = make_crf_terms(features, result.probabilities, classes, boundary);
    result.label = solve_crf(features, terms, model.crf);
    merge_small_components(features, model.crf, model.smallest_component, result.label);
    lap("cut");
    for (std::size_t f = 0; f < result.label.size(); ++f)
        result.confidence.push_back(result.probabilities[f * classes + result.label[f]]);
    return result;
}

}  // namespace exemplar
