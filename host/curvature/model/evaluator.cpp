#include "host/curvature/model/model.h"

namespace exemplar {

namespace {

/// Reads vectors in memory order, which is fastest, so that patches and tiles then find them in the cache. A
/// prefetch instruction helps less than half as much.
void bring_to_cache(std::span<const Vec3> vectors) {
    constexpr std::size_t k_in_cache_line = 64 / sizeof(Vec3);
    for (std::size_t v = 0; v < vectors.size(); v += k_in_cache_line)
        static_cast<void>(*static_cast<const volatile float*>(vectors[v].data()));
}

}  // namespace

CurvatureEvaluator::CurvatureEvaluator(const CurvatureModel& model)
    : model_(&model),
      is_identity_(model.regression.is_identity()),
      x_(model.state.input_count),
      features_(model.regression.feature_count()),
      z_(model.regression.components.size()) {
    if (model.state.is_local()) local_.emplace(model.state);
}

const VertexCurvature& CurvatureEvaluator::evaluate(const Rig& rig, const Pose& pose, std::span<const Vec3> vertices,
                                                    std::span<const Vec3> normals) {
    if (model_->state.is_local()) return evaluate(vertices, normals);
    bring_to_cache(vertices);
    bring_to_cache(normals);
    model_->state.read_pose(pose, x_);
    if (model_->tiles.set == AttributeSet::principal)
        model_->segments.rotations_of_rig(bone_transforms(rig, pose), rotations_);
    return reproject(vertices, normals);
}

const VertexCurvature& CurvatureEvaluator::evaluate(std::span<const Vec3> vertices, std::span<const Vec3> normals) {
    bring_to_cache(vertices);
    bring_to_cache(normals);
    if (model_->segments.count() > 0) model_->segments.rotations_of_sequence(vertices, rotations_);
    if (local_)
        local_->read(vertices, normals, rotations_, x_);
    else
        model_->state.read_surface(vertices, normals, rotations_, x_);
    return reproject(vertices, normals);
}

const VertexCurvature& CurvatureEvaluator::reproject(std::span<const Vec3> vertices, std::span<const Vec3> normals) {
    farthest_ = model_->range.prepare(model_->state, x_);
    if (is_identity_)
        z_ = x_;
    else
        model_->regression.evaluate(x_, features_, z_);
    reproject_curvature(model_->tiles, z_, {vertices, normals, rotations_}, curvature_);
    return curvature_;
}

}  // namespace exemplar
