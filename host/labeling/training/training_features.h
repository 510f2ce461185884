#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host/labeling/features/features.h"

namespace exemplar {

/// The features of the meshes that a model is trained on. Those that fit into the memory that they may take stay there;
/// each of the others is read again whenever it is needed.
class TrainingFeatures {
  public:
    /// Reads or computes the features of a mesh; they are the same every time.
    using Load = std::function<MeshFeatures(std::size_t mesh)>;

    /// All stay in memory, in `features`, which must outlive this; training appends columns to them.
    explicit TrainingFeatures(std::vector<MeshFeatures>& features);
    /// Loads each mesh once, in order, and keeps the first ones, up to `bytes` in all. `loaded` is called after each.
    TrainingFeatures(std::size_t meshes, Load load, std::size_t bytes, const std::function<void(std::size_t)>& loaded);
    TrainingFeatures(const TrainingFeatures&) = delete;
    TrainingFeatures& operator=(const TrainingFeatures&) = delete;

    std::size_t count() const { return features_.size(); }
    /// Returns the features of a mesh. Those of a mesh that is not kept, with what was appended to them, are gone as
    /// soon as those of another such mesh are asked for.
    MeshFeatures& at(std::size_t mesh);
    /// Returns what the graph cut knows of a mesh: the areas of its faces, and its edges with their lengths and angles.
    /// It is always in memory; other fields may be empty.
    const MeshFeatures& outline(std::size_t mesh) const { return features_[mesh]; }

  private:
    std::vector<MeshFeatures> own_;
    std::vector<MeshFeatures>& features_;  ///< from kept_ on, outlines only
    std::size_t kept_;
    Load load_;
    std::optional<std::size_t> read_again_;  ///< the mesh of again_
    MeshFeatures again_;
};

}  // namespace exemplar
