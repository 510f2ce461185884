#include "host/labeling/painting/suggestions.h"

#include <algorithm>
#include <numeric>

#include "host/labeling/inference/crf.h"

namespace exemplar {
namespace {

constexpr std::int32_t k_not_in_palette = -1;

/// Returns, for each label of the model, its index in the palette.
std::vector<std::int32_t> palette_indices(const LabelingModel& model, std::span<const std::string> palette) {
    std::vector<std::int32_t> index;
    index.reserve(model.class_count());
    for (const std::string& name : model.label_names) {
        const auto place = std::ranges::find(palette, name);
        index.push_back(place == palette.end() ? k_not_in_palette : static_cast<std::int32_t>(place - palette.begin()));
    }
    return index;
}

LabelEvidence evidence_of(const LabelingModel& model, const MeshFeatures& features, const FaceScores& scores,
                          std::span<const std::int32_t> index, std::size_t labels) {
    const std::size_t classes = model.class_count(), faces = features.face_area.size();
    LabelEvidence evidence;
    evidence.edges = features.edges;
    const double area = std::accumulate(features.face_area.begin(), features.face_area.end(), 0.0);
    evidence.edge_cost =
        border_costs(features, make_crf_terms(features, scores.probabilities, classes, scores.boundary), model.crf);
    for (double& cost : evidence.edge_cost) cost /= std::max(area, 1e-30);
    evidence.probabilities.assign(faces * labels, 0);
    evidence.compatibility.assign(labels * labels, 1);
    for (std::size_t c = 0; c < labels; ++c) evidence.compatibility[c * labels + c] = 0;
    for (std::size_t c = 0; c < classes; ++c) {
        if (index[c] == k_not_in_palette) continue;
        const auto own = static_cast<std::size_t>(index[c]);
        for (std::size_t f = 0; f < faces; ++f)
            evidence.probabilities[f * labels + own] = scores.probabilities[f * classes + c];
        for (std::size_t other = 0; other < classes; ++other)
            if (index[other] != k_not_in_palette)
                evidence.compatibility[own * labels + static_cast<std::size_t>(index[other])] =
                    model.crf.compatibility[c * classes + other];
    }
    return evidence;
}

}  // namespace

TrainOptions suggestion_training() {
    TrainOptions options;
    options.rounds = 100;
    options.max_stages = 2;
    options.rows_per_mesh = 3000;
    options.orientation = OrientationUse::never;  // judging it would cost a third more, while a person waits
    return options;
}

LabeledCorpus without_unused_labels(LabeledCorpus corpus) {
    std::vector<std::int32_t> renamed(corpus.names.size(), k_not_in_palette);
    for (const LabeledMesh& mesh : corpus.meshes)
        for (const std::int32_t label : mesh.label)
            if (label >= 0) renamed[static_cast<std::size_t>(label)] = 0;
    std::vector<std::string> names;
    names.reserve(corpus.names.size());
    for (std::size_t c = 0; c < renamed.size(); ++c) {
        if (renamed[c] == k_not_in_palette) continue;
        renamed[c] = static_cast<std::int32_t>(names.size());
        names.push_back(corpus.names[c]);
    }
    for (LabeledMesh& mesh : corpus.meshes)
        for (std::int32_t& label : mesh.label)
            if (label >= 0) label = renamed[static_cast<std::size_t>(label)];
    corpus.names = std::move(names);
    return corpus;
}

std::vector<Suggestion> suggest_labels(const LabelingModel& model, std::span<MeshFeatures* const> meshes,
                                       std::span<const std::string> palette, const LabelingBackend& backend) {
    const std::vector<std::int32_t> index = palette_indices(model, palette);
    std::vector<FaceScores> scores = score_faces(model, meshes, backend);
    std::vector<Suggestion> suggestions(meshes.size());
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        Suggestion& suggestion = suggestions[m];
        suggestion.evidence = evidence_of(model, *meshes[m], scores[m], index, palette.size());
        const FaceLabeling labeling = cut_faces(model, *meshes[m], std::move(scores[m]));
        suggestion.labels.confidence = labeling.confidence;
        suggestion.labels.label.reserve(labeling.label.size());
        for (const std::int32_t label : labeling.label)
            suggestion.labels.label.push_back(index[static_cast<std::size_t>(label)]);
    }
    return suggestions;
}

bool much_the_same(std::span<const std::int32_t> rejected, std::span<const std::int32_t> now) {
    if (rejected.size() != now.size()) return false;
    std::size_t changed = 0;
    for (std::size_t f = 0; f < now.size(); ++f) changed += rejected[f] != now[f] ? 1 : 0;
    return changed * 20 < now.size();
}

float uncertainty_of(std::span<const float> face_area, std::span<const float> confidence) {
    double sum = 0, total = 0;
    for (std::size_t f = 0; f < face_area.size(); ++f) {
        sum += static_cast<double>(face_area[f]) * static_cast<double>(confidence[f]);
        total += static_cast<double>(face_area[f]);
    }
    return total > 0 ? static_cast<float>(1 - sum / total) : 1;
}

}  // namespace exemplar
