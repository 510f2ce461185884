#include "host/labeling/painting/folder_learning.h"

#include <algorithm>

#include "host/core/progress.h"
#include "host/data/corpus.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/painting/suggestions.h"
#include "host/mesh/io/io.h"

namespace exemplar {

std::shared_ptr<const LabelingModel> learn_from_verified(std::span<const FolderShape> shapes,
                                                         const std::filesystem::path& cache,
                                                         const LabelingBackend& backend) {
    std::vector<std::filesystem::path> paths;
    for (const FolderShape& shape : shapes)
        if (shape.verified) paths.push_back(shape.path);
    if (paths.empty()) return nullptr;
    if (paths.size() > k_max_training_shapes)
        paths.erase(paths.begin(), paths.end() - static_cast<std::ptrdiff_t>(k_max_training_shapes));
    const LabeledCorpus corpus = working_corpus(without_unused_labels(load_corpus(paths)));
    if (corpus.names.size() < 2) return nullptr;
    std::vector<MeshFeatures> features;
    features.reserve(corpus.meshes.size());
    Progress progress("measuring verified shapes", corpus.meshes.size());
    for (const LabeledMesh& mesh : corpus.meshes) {
        features.push_back(cached_features(mesh.mesh, suggestion_training().features, cache));
        progress.advance();
    }
    progress.finish();
    TrainReport report;
    return std::make_shared<const LabelingModel>(
        train_labeling(corpus, features, suggestion_training(), backend, report));
}

SuggestedShape suggest_shape(const LabelingModel& model, const std::filesystem::path& path,
                             std::span<const std::string> palette, const std::filesystem::path& cache,
                             const LabelingBackend& backend) {
    SuggestedShape shape;
    shape.mesh = read_mesh(path).mesh;
    WorkingFeatures working = working_features(model.feature_options, shape.mesh, cache);
    shape.descriptor = compute_shape_descriptor(working.features);
    MeshFeatures* const one = &working.features;
    const CompletedLabels labels =
        std::move(suggest_labels(model, std::span(&one, 1), palette, backend).front().labels);
    shape.uncertainty = std::max(uncertainty_of(working.features.face_area, labels.confidence), 1e-3F);
    std::vector<std::int32_t> triangle_label;
    triangle_label.reserve(working.face_of.size());
    shape.confidence.reserve(working.face_of.size());
    for (const std::uint32_t face : working.face_of) {
        triangle_label.push_back(labels.label[face]);
        shape.confidence.push_back(labels.confidence[face]);
    }
    shape.label = to_source_faces(shape.mesh, triangle_label);
    return shape;
}

}  // namespace exemplar
