#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/curvature/model/predictor.h"
#include "host/curvature/state/local_shape.h"
#include "host/curvature/state/segments.h"
#include "host/curvature/state/state.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {

/// A learned map from the pose of one surface to its curvature.
struct CurvatureModel {
    AnimationKind kind = AnimationKind::sequence;
    std::uint64_t topology = 0;  ///< topology_hash of the surface it was learned on
    std::size_t vertex_count = 0;
    CurvatureOptions truth;  ///< how training curvature was measured; smoothing_unit in mesh units
    float feature_size = 0;  ///< mean over the training poses (see host/lines)
    StateReader state;
    PoseRange range;
    Segments segments;  ///< for principal attributes and local shape; the tiles list their vertices
    ComponentRegression regression;
    BasisTiles tiles;
    std::map<std::string, std::string> training;  ///< remarks in words: animation, clips, options
};

/// Returns a hash of faces and vertex count.
std::uint64_t topology_hash(std::span<const Face> faces, std::size_t vertex_count);

/// Write and read model files (docs/formats.md). Reading checks everything and throws a ModelError that names the
/// path and what is wrong.
void save_curvature_model(const std::filesystem::path& path, const CurvatureModel& model);
CurvatureModel load_curvature_model(const std::filesystem::path& path);

/// Throws ModelError if the model was learned on another surface or rig: another kind of animation, other faces, or
/// missing joints, blend shapes or bones.
void require_compatible(const CurvatureModel& model, const Animation& animation);

/// Evaluates a model for one surface, frame after frame, on one thread. Keeps its work space.
class CurvatureEvaluator {
  public:
    explicit CurvatureEvaluator(const CurvatureModel& model);
    /// Returns the curvature in a pose of the rig, given vertices and unit vertex normals of the posed surface. The
    /// result is valid until the next call.
    const VertexCurvature& evaluate(const Rig& rig, const Pose& pose, std::span<const Vec3> vertices,
                                    std::span<const Vec3> normals);
    /// Does the same for a mesh sequence or a model of local shape.
    const VertexCurvature& evaluate(std::span<const Vec3> vertices, std::span<const Vec3> normals);
    /// Does the same for a shape of either kind, of which these are the vertices.
    const VertexCurvature& evaluate(const Rig& rig, const SurfaceShape& shape, std::span<const Vec3> vertices,
                                    std::span<const Vec3> normals) {
        return shape.pose ? evaluate(rig, *shape.pose, vertices, normals) : evaluate(vertices, normals);
    }
    /// Returns the control that was farthest from the training poses in the last call.
    PoseRange::Farthest farthest() const { return farthest_; }
    std::span<const float> components() const { return z_; }

  private:
    const VertexCurvature& reproject(std::span<const Vec3> vertices, std::span<const Vec3> normals);
    const CurvatureModel* model_;
    std::optional<LocalShapeReader> local_;
    bool is_identity_;
    std::vector<float> x_, features_, z_;
    PoseRange::Farthest farthest_;
    std::vector<Eigen::Matrix3f> rotations_;
    VertexCurvature curvature_;
};

}  // namespace exemplar
