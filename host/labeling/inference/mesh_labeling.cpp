#include "host/labeling/inference/mesh_labeling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "host/core/stopwatch.h"
#include "host/labeling/features/feature_cache.h"
#include "host/mesh/editing/validate.h"
#include "host/mesh/editing/weld.h"

namespace exemplar {
namespace {

/// Copies values per working face, `width` each, to the faces of the original.
template <typename T>
std::vector<T> per_original_face(const std::vector<T>& values, const std::vector<std::uint32_t>& face_of,
                                 std::size_t width = 1) {
    std::vector<T> result(face_of.size() * width);
    for (std::size_t f = 0; f < face_of.size(); ++f)
        for (std::size_t i = 0; i < width; ++i) result[f * width + i] = values[face_of[f] * width + i];
    return result;
}

/// Returns, for each simplified face, the label (or none, -1) that has the most area among the faces it replaces.
std::vector<std::int32_t> labels_by_area(const LabeledMesh& original, const SimplifiedMesh& simple,
                                         std::size_t classes) {
    const std::vector<float> area = face_areas(original.mesh);
    const std::size_t choices = classes + 1;
    std::vector<float> votes(simple.mesh.face_count() * choices, 0);
    for (std::size_t f = 0; f < area.size(); ++f)
        votes[simple.face_of[f] * choices + static_cast<std::size_t>(original.label[f] + 1)] += area[f];
    std::vector<std::int32_t> label;
    for (auto face = votes.begin(); face != votes.end(); face += static_cast<std::ptrdiff_t>(choices)) {
        const auto most = std::max_element(face, face + static_cast<std::ptrdiff_t>(choices));
        label.push_back(static_cast<std::int32_t>(most - face) - 1);
    }
    return label;
}

}  // namespace

std::vector<std::string> labeling_warnings(const TriangleMesh& mesh, const std::string& name) {
    std::vector<std::string> warnings;
    const TriangleMesh joined = welded(mesh);
    if (const std::size_t count = mesh.vertex_count() - joined.vertex_count(); count > 0)
        warnings.push_back(
            fmt::format("{} {} at the place of another: joined", count, count == 1 ? "vertex is" : "vertices are"));
    for (std::string& message : require_usable(joined, name).messages()) warnings.push_back(std::move(message));
    return warnings;
}

SimplifiedMesh working_mesh(const TriangleMesh& mesh, std::size_t max_faces) {
    return simplify_mesh(welded(mesh), max_faces);
}

LabeledCorpus working_corpus(LabeledCorpus corpus, std::size_t max_faces) {
    for (LabeledMesh& mesh : corpus.meshes) {
        SimplifiedMesh working = working_mesh(mesh.mesh, max_faces);
        if (working.mesh.face_count() < mesh.mesh.face_count())
            mesh.label = labels_by_area(mesh, working, corpus.names.size());
        mesh.mesh = std::move(working.mesh);
    }
    return corpus;
}

WorkingFeatures working_features(const FeatureOptions& options, const TriangleMesh& mesh,
                                 const std::filesystem::path& cache, std::size_t max_faces) {
    const Stopwatch watch;
    SimplifiedMesh working = working_mesh(mesh, max_faces);
    WorkingFeatures prepared;
    prepared.cache_entry = feature_entry_name(working.mesh, options);
    prepared.features = cached_features(working.mesh, options, cache);
    prepared.face_of = std::move(working.face_of);
    prepared.seconds = watch.wall();
    return prepared;
}

FaceLabeling finish_labeling(const LabelingModel& model, const WorkingFeatures& mesh, FaceScores scores) {
    FaceLabeling labeling = cut_faces(model, mesh.features, std::move(scores));
    labeling.seconds.emplace(labeling.seconds.begin(), "features", mesh.seconds);
    labeling.label = per_original_face(labeling.label, mesh.face_of);
    labeling.confidence = per_original_face(labeling.confidence, mesh.face_of);
    if (!labeling.border.empty()) labeling.border = per_original_face(labeling.border, mesh.face_of);
    labeling.probabilities = per_original_face(labeling.probabilities, mesh.face_of, model.class_count());
    return labeling;
}

FaceLabeling label_mesh(const LabelingModel& model, const TriangleMesh& mesh, const std::filesystem::path& cache,
                        const LabelingBackend& backend, std::size_t max_faces) {
    WorkingFeatures prepared = working_features(model.feature_options, mesh, cache, max_faces);
    MeshFeatures* const one = &prepared.features;
    return finish_labeling(model, prepared, std::move(score_faces(model, std::span(&one, 1), backend).front()));
}

}  // namespace exemplar
