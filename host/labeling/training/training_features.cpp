#include "host/labeling/training/training_features.h"

#include <algorithm>
#include <utility>

#include "host/labeling/inference/labeler.h"

namespace exemplar {
namespace {

template <typename Value>
std::size_t bytes_of(const std::vector<Value>& values) {
    return values.size() * sizeof(Value);
}

MeshFeatures outline_of(MeshFeatures&& mesh) {
    MeshFeatures outline;
    outline.face_area = std::move(mesh.face_area);
    outline.edges = std::move(mesh.edges);
    outline.edge_length = std::move(mesh.edge_length);
    outline.dihedral = std::move(mesh.dihedral);
    return outline;
}

}  // namespace

std::size_t feature_bytes(const MeshFeatures& mesh) {
    return bytes_of(mesh.unary.values) + bytes_of(mesh.pairwise.values) + bytes_of(mesh.context.geodesic_bin) +
           bytes_of(mesh.context.axis_position) + bytes_of(mesh.edge_context.edge) + bytes_of(mesh.edge_context.bin);
}

TrainingFeatures::TrainingFeatures(std::vector<MeshFeatures>& features)
    : features_(features), is_kept_(features.size(), true) {}

TrainingFeatures::TrainingFeatures(std::size_t meshes, Source source, std::size_t bytes,
                                   const std::function<void(std::size_t)>& loaded)
    : features_(own_), source_(std::move(source)) {
    own_.reserve(meshes);
    for (std::size_t mesh = 0; mesh < meshes; ++mesh) {
        MeshFeatures features = source_.load(mesh);
        const std::size_t size = feature_bytes(features);
        is_kept_.push_back(size <= bytes || !source_.is_stored(mesh));
        if (is_kept_.back()) bytes -= std::min(size, bytes);
        own_.push_back(is_kept_.back() ? std::move(features) : outline_of(std::move(features)));
        loaded(mesh);
    }
}

MeshFeatures& TrainingFeatures::at(std::size_t mesh) {
    if (is_kept_[mesh]) return features_[mesh];
    if (read_again_ != mesh) {
        read_again_.reset();
        again_ = {};  // first, so that there are never two
        again_ = source_.load(mesh);
        read_again_ = mesh;
    }
    return again_;
}

void TrainingFeatures::drop_appended() {
    for (std::size_t mesh = 0; mesh < count(); ++mesh)
        if (is_kept_[mesh]) drop_context_columns(features_[mesh]);
    if (read_again_) drop_context_columns(again_);
}

}  // namespace exemplar
