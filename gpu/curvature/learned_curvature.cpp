#include "gpu/curvature/learned_curvature.h"

#include <fmt/format.h>

#include <algorithm>

#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::vec4;

constexpr std::size_t k_rows_per_segment = 3;

}  // namespace

GpuLearnedCurvature::GpuLearnedCurvature(Device& device, const CurvatureModel& model,
                                         const ReprojectionOptions& options)
    : vertex_count_(model.tiles.vertex_count),
      reader_(model.state),
      segments_(model.segments),
      predictor_(device, model.regression),
      reprojection_(device, model.tiles, model.regression.components.size(), model.segments.count(), options),
      x_(model.state.input_count),
      rotations_(model.segments.count()) {
    if (model.regression.input_count != model.state.input_count)
        throw ModelError(
            fmt::format("a curvature model is damaged: it has {} inputs and predicts from {}; train it "
                        "again",
                        model.state.input_count, model.regression.input_count));
    for (const Influence& influence : segments_.influences)
        fewest_bones_ = std::max<std::size_t>(fewest_bones_, influence.bone + 1);
    for (const std::uint32_t node : reader_.nodes) fewest_controls_ = std::max<std::size_t>(fewest_controls_, node + 1);
    state_ = Buffer(device,
                    k_rows_per_segment * sizeof(vec4) * rotations_.size() + sizeof(float) * predictor_.padded_inputs());
}

void GpuLearnedCurvature::record(Stream& stream, const Rig& rig, const Pose& pose, const Buffer& normals) {
    if (reader_.kind == AnimationKind::sequence)
        throw UsageError("curvature learned on a mesh sequence is not that of a pose; give vertices");
    const bool shapes = reader_.kind == AnimationKind::blend_shapes;
    if (rig.bones.size() < fewest_bones_ || pose.nodes.size() != rig.nodes.size() ||
        (shapes ? pose.weights.size() : pose.nodes.size()) < fewest_controls_)
        throw UsageError(
            fmt::format("a pose of {} nodes and {} weights of a rig of {} bones is not one the curvature "
                        "model was learned on, which needs {} bones and {} {}",
                        pose.nodes.size(), pose.weights.size(), rig.bones.size(), fewest_bones_, fewest_controls_,
                        shapes ? "weights" : "nodes"));
    reader_.read_pose(pose, x_);
    segments_.rotations_of_rig(bone_transforms(rig, pose), rotations_);
    record_state(stream, normals);
}

void GpuLearnedCurvature::record(Stream& stream, std::span<const Vec3> vertices, const Buffer& normals) {
    if (reader_.kind != AnimationKind::sequence)
        throw UsageError("curvature learned on a rig is not that of vertices; give a pose");
    if (vertices.size() != vertex_count_)
        throw UsageError(
            fmt::format("a frame of {} vertices is not of a surface of {}", vertices.size(), vertex_count_));
    reader_.read_vertices(vertices, x_);
    segments_.rotations_of_sequence(vertices, rotations_);
    record_state(stream, normals);
}

void GpuLearnedCurvature::record_state(Stream& stream, const Buffer& normals) {
    stream.upload_with(state_, state_.bytes(), 0, [&](std::span<std::byte> memory) { write_state(memory); });
    predictor_.record(stream, state_, k_rows_per_segment * 4 * rotations_.size());
    reprojection_.record(stream, predictor_.components(), state_, normals);
}

void GpuLearnedCurvature::write_state(std::span<std::byte> memory) const {
    auto* rows = reinterpret_cast<vec4*>(memory.data());
    for (const Eigen::Matrix3f& rotation : rotations_)
        for (Eigen::Index i = 0; i < 3; ++i) *rows++ = {rotation(i, 0), rotation(i, 1), rotation(i, 2), 0.0f};
    auto* const inputs = reinterpret_cast<float*>(rows);
    std::fill(std::copy(x_.begin(), x_.end(), inputs), inputs + predictor_.padded_inputs(), 0.0f);
    inputs[x_.size()] = 1.0f;
}

}  // namespace exemplar
