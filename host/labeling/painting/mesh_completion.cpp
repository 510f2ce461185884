#include "host/labeling/painting/mesh_completion.h"

#include "host/labeling/features/feature_cache.h"
#include "host/labeling/painting/suggestions.h"

namespace exemplar {

MeshCompletion::MeshCompletion(const TriangleMesh& mesh, std::size_t max_faces)
    : working_(working_mesh(mesh, max_faces)), completion_(working_.mesh) {}

MeshFeatures MeshCompletion::compute_features(const std::filesystem::path& cache) const {
    return cached_features(working_.mesh, suggestion_training().features, cache);
}

CompletedLabels MeshCompletion::on_original(const CompletedLabels& working) const {
    CompletedLabels result;
    result.label.reserve(working_.face_of.size());
    result.confidence.reserve(working_.face_of.size());
    for (const std::uint32_t face : working_.face_of) {
        result.label.push_back(working.label[face]);
        result.confidence.push_back(working.confidence[face]);
    }
    return result;
}

CompletedLabels MeshCompletion::complete(std::span<const std::int32_t> painted, std::size_t labels) const {
    std::vector<std::int32_t> on_working(working_.mesh.face_count(), -1);
    for (std::size_t f = 0; f < painted.size(); ++f)
        if (painted[f] >= 0) on_working[working_.face_of[f]] = painted[f];
    CompletedLabels result = on_original(completion_.complete(on_working, labels));
    for (std::size_t f = 0; f < painted.size(); ++f)
        if (painted[f] >= 0) result.label[f] = painted[f], result.confidence[f] = 1;
    return result;
}

}  // namespace exemplar
