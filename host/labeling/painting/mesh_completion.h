#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/painting/completion.h"

namespace exemplar {

/// Completion on a mesh of any size. Large meshes are completed on their working mesh (see working_mesh); what is
/// painted on a face of the original holds for that face in any case.
class MeshCompletion {
  public:
    /// Prepares completion by nearness alone; takes tens of milliseconds for 20,000 faces.
    explicit MeshCompletion(const TriangleMesh& mesh, std::size_t max_faces = k_max_working_faces);
    /// Computes the features, or reads them from the cache; takes seconds. May run beside complete(). Throws as
    /// cached_features.
    MeshFeatures compute_features(const std::filesystem::path& cache) const;
    /// Adds likeness to nearness.
    void set_descriptors(FaceDescriptors descriptors) { completion_.set_descriptors(std::move(descriptors)); }
    void set_evidence(LabelEvidence evidence) { completion_.set_evidence(std::move(evidence)); }

    /// Completes what is painted on the original: a label per face below `labels`, or -1.
    CompletedLabels complete(std::span<const std::int32_t> painted, std::size_t labels) const;
    /// Returns values per face of the working mesh as values per face of the original.
    CompletedLabels on_original(const CompletedLabels& working) const;

  private:
    SimplifiedMesh working_;
    LabelCompletion completion_;
};

}  // namespace exemplar
