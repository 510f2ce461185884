#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/curvature/state/local_shape.h"
#include "host/curvature/model/predictor.h"
#include "host/curvature/state/segments.h"
#include "host/curvature/state/state.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {

/// A learned map from the pose of one surface to its curvature.
struct CurvatureModel {
    AnimationKind kind = AnimationKind::sequence;
    std::uint64_t topology = 0;  ///< of the faces and the vertex count it was learned on (see topology_hash)
    std::size_t vertex_count = 0;
    CurvatureOptions truth;  ///< how the curvature it learned was measured; smoothing_unit in mesh units
    float feature_size = 0;  ///< of the surface in training (see lines)
    StateReader state;
    PoseRange range;
    Segments segments;  ///< of principal attributes and local shape; the tiles tell which vertices are of which
    ComponentRegression regression;
    BasisTiles tiles;
    std::map<std::string, std::string> training;  ///< remarks: animation, clips, options, in words
};

/// A fingerprint of faces and vertex count.
std::uint64_t topology_hash(std::span<const Face> faces, std::size_t vertex_count);

/// Writes and reads model files (docs/formats.md). Reading checks everything: ModelError names the path and what is
/// wrong.
void save_curvature_model(const std::filesystem::path& path, const CurvatureModel& model);
CurvatureModel load_curvature_model(const std::filesystem::path& path);

/// Throws ModelError if the model was learned on another surface or rig: other faces, or joints or shapes it needs are
/// not there.
void require_fit(const CurvatureModel& model, const Animation& animation);

/// Evaluates a model for one surface, frame after frame, on one thread; keeps its work space.
class CurvatureEvaluator {
  public:
    explicit CurvatureEvaluator(const CurvatureModel& model);
    /// Curvature at a pose of the rig, given vertices and unit vertex normals of the posed surface; valid until the
    /// next call.
    const VertexCurvature& evaluate(const Rig& rig, const Pose& pose, std::span<const Vec3> vertices,
                                    std::span<const Vec3> normals);
    /// The same of a mesh sequence.
    const VertexCurvature& evaluate(std::span<const Vec3> vertices, std::span<const Vec3> normals);
    /// The control of the last call that was farthest from the training poses.
    PoseRange::Farthest farthest() const { return farthest_; }
    std::span<const float> components() const { return z_; }
    std::span<const Eigen::Matrix3f> rotations() const { return rotations_; }

  private:
    const VertexCurvature& reproject(std::span<const Vec3> vertices, std::span<const Vec3> normals);
    const CurvatureModel* model_;
    std::optional<LocalShapeReader> local_;
    bool copies_inputs_;
    std::vector<float> x_, features_, z_;
    PoseRange::Farthest farthest_;
    std::vector<Eigen::Matrix3f> rotations_;
    VertexCurvature curvature_;
};

}  // namespace exemplar
