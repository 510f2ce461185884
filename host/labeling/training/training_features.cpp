#include "host/labeling/training/training_features.h"

#include <utility>

namespace exemplar {
namespace {

template <typename Value>
std::size_t size_in_bytes(const std::vector<Value>& values) {
    return values.size() * sizeof(Value);
}

/// The bytes of what is large.
std::size_t size_in_bytes(const MeshFeatures& mesh) {
    return size_in_bytes(mesh.unary.values) + size_in_bytes(mesh.pairwise.values) +
           size_in_bytes(mesh.context.geodesic_bin) + size_in_bytes(mesh.context.axis_position) +
           size_in_bytes(mesh.edge_context.edge) + size_in_bytes(mesh.edge_context.bin);
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

TrainingFeatures::TrainingFeatures(std::vector<MeshFeatures>& features) : features_(features), kept_(features.size()) {}

TrainingFeatures::TrainingFeatures(std::size_t meshes, Load load, std::size_t bytes,
                                   const std::function<void(std::size_t)>& loaded)
    : features_(own_), kept_(0), load_(std::move(load)) {
    own_.reserve(meshes);
    bool fits = true;
    for (std::size_t mesh = 0; mesh < meshes; ++mesh) {
        MeshFeatures features = load_(mesh);
        const std::size_t size = size_in_bytes(features);
        fits = fits && size <= bytes;
        if (fits) bytes -= size, ++kept_;
        own_.push_back(fits ? std::move(features) : outline_of(std::move(features)));
        loaded(mesh);
    }
}

MeshFeatures& TrainingFeatures::at(std::size_t mesh) {
    if (mesh < kept_) return features_[mesh];
    if (read_again_ != mesh) {
        again_ = {};  // first, so that there are never two
        again_ = load_(mesh);
        read_again_ = mesh;
    }
    return again_;
}

}  // namespace exemplar
