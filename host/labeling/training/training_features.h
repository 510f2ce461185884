#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host/labeling/features/features.h"

namespace exemplar {

/// The features of the meshes that a model is trained on. They may take a limited amount of memory: the features of
/// some meshes stay there, those of the others are loaded whenever they are needed.
class TrainingFeatures {
  public:
    /// Loads features, also more than once.
    struct Source {
        std::function<MeshFeatures(std::size_t mesh)> load;  ///< reads or computes them: the same every time
        std::function<bool(std::size_t mesh)> is_stored;     ///< whether a second `load` would only read them
    };

    /// All stay in memory, in `features`, which must outlive this; training appends columns to them.
    explicit TrainingFeatures(std::vector<MeshFeatures>& features);
    /// Loads each mesh once, in order, and keeps those that fit into `bytes` together, and those that are not stored.
    /// The columns that training appends are not counted. `loaded` is called after each mesh.
    TrainingFeatures(std::size_t meshes, Source source, std::size_t bytes,
                     const std::function<void(std::size_t)>& loaded);
    TrainingFeatures(const TrainingFeatures&) = delete;
    TrainingFeatures& operator=(const TrainingFeatures&) = delete;

    std::size_t count() const { return features_.size(); }
    /// Returns the features of a mesh. Those of a mesh that is not kept, with what was appended to them, are gone as
    /// soon as those of another such mesh are asked for.
    MeshFeatures& at(std::size_t mesh);
    /// Returns what the graph cut knows of a mesh: the areas of its faces, and its edges with their lengths and angles.
    /// It is always in memory; other fields may be empty.
    const MeshFeatures& outline(std::size_t mesh) const { return features_[mesh]; }
    /// Removes the columns that an earlier training appended.
    void drop_appended();

  private:
    std::vector<MeshFeatures> own_;
    std::vector<MeshFeatures>& features_;  ///< outlines only of meshes that are not kept
    std::vector<bool> is_kept_;
    Source source_;
    std::optional<std::size_t> read_again_;  ///< the mesh of again_
    MeshFeatures again_;
};

/// Returns the bytes of the large arrays of a mesh's features.
std::size_t feature_bytes(const MeshFeatures& mesh);

}  // namespace exemplar
