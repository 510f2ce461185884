#include "gpu/curvature/learned/learned_curvature.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "host/core/errors.h"

namespace exemplar {
namespace {

using shared::vec4;

constexpr std::size_t k_rows_per_segment = 3;

void check_inputs(const CurvatureModel& model) {
    const std::size_t inputs = model.state.input_count, controls = model.state.controls.size();
    const auto refuse = [](const std::string& what) {
        throw ModelError("a curvature model is damaged: " + what + "; train it again");
    };
    if (model.regression.input_count != inputs)
        refuse(fmt::format("it has {} inputs and predicts from {}", inputs, model.regression.input_count));
    const PoseRange& range = model.range;
    if (range.mean.size() != static_cast<Eigen::Index>(inputs) ||
        range.whitening.size() != (model.state.is_local() ? 0 : controls) || range.largest.size() != controls)
        refuse(fmt::format("its range is not of {} inputs of {} controls", inputs, controls));
    for (std::size_t c = 0; c < controls; ++c) {
        const Control& control = model.state.controls[c];
        const Eigen::Index count = control.input_count;
        const auto is_square = [&](const Eigen::MatrixXf& m) { return m.rows() == count && m.cols() == count; };
        if (std::size_t{control.first_input} + control.input_count > inputs ||
            (!model.state.is_local() && !is_square(range.whitening[c])))
            refuse(fmt::format("control '{}' has inputs that do not exist", control.name));
    }
}

Segments needed_segments(const CurvatureModel& model) {
    return model.tiles.set == AttributeSet::principal ? model.segments : Segments{};
}

}  // namespace

GpuLearnedCurvature::GpuLearnedCurvature(Device& device, const CurvatureModel& model,
                                         const ReprojectionOptions& options)
    : vertex_count_(model.tiles.vertex_count),
      reader_(model.state),
      range_(model.range),
      segments_(needed_segments(model)),
      predictor_(device, model.regression),
      is_identity_(model.regression.is_identity()),
      reprojection_(device, model.tiles, model.regression.components.size(), segments_.count(), options),
      x_(model.state.input_count),
      rotations_(segments_.count()) {
    check_inputs(model);
    for (const Influence& influence : segments_.influences)
        min_bones_ = std::max<std::size_t>(min_bones_, influence.bone + 1);
    for (const std::uint32_t part : reader_.parts_of_rig())
        min_controls_ = std::max<std::size_t>(min_controls_, part + 1);
    if (reader_.is_local())
        local_.emplace(device, model, predictor_.padded_inputs());
    else
        state_ = Buffer(
            device, k_rows_per_segment * sizeof(vec4) * rotations_.size() + sizeof(float) * predictor_.padded_inputs());
}

void GpuLearnedCurvature::record(Stream& stream, const Frame& frame) {
    check_buffers(frame);
    if (local_) {
        local_->record(stream, frame.vertices, frame.normals);
        if (!is_identity_) predictor_.record(stream, local_->inputs(), 0);
    } else {
        if (reader_.is_of_rig())
            read_pose(frame);
        else
            read_vertices(frame);
        farthest_ = range_.prepare(reader_, x_);
        stream.upload_with(state_, state_.bytes(), 0, [&](std::span<std::byte> memory) { write_state(memory); });
        predictor_.record(stream, state_, k_rows_per_segment * 4 * rotations_.size());
    }
    reprojection_.record(
        stream, local_ && is_identity_ ? local_->inputs() : predictor_.components(),
        {.vertices = frame.vertices, .normals = frame.normals, .rotations = local_ ? local_->rotations() : state_});
}

void GpuLearnedCurvature::check_buffers(const Frame& frame) const {
    const std::size_t vertices = frame.vertices.bytes() / sizeof(vec4), normals = frame.normals.bytes() / sizeof(vec4);
    if (vertices != vertex_count_ || normals != vertex_count_)
        throw UsageError(fmt::format("{} vertices and {} normals are not of a surface of {} vertices", vertices,
                                     normals, vertex_count_));
}

void GpuLearnedCurvature::read_pose(const Frame& frame) {
    if (!frame.pose) throw UsageError("curvature learned on a rig is not that of vertices; give a pose");
    const bool shapes = std::holds_alternative<WeightState>(reader_.source);
    const Rig& rig = *frame.rig;
    const Pose& pose = *frame.pose;
    if (rig.bones.size() < min_bones_ || pose.nodes.size() != rig.nodes.size() ||
        (shapes ? pose.weights.size() : pose.nodes.size()) < min_controls_)
        throw UsageError(
            fmt::format("a pose of {} nodes and {} weights of a rig of {} bones is not one the curvature "
                        "model was learned on, which needs {} bones and {} {}",
                        pose.nodes.size(), pose.weights.size(), rig.bones.size(), min_bones_, min_controls_,
                        shapes ? "weights" : "nodes"));
    reader_.read_pose(pose, x_);
    if (segments_.count() != 0) segments_.rotations_of_rig(bone_transforms(rig, pose), rotations_);
}

void GpuLearnedCurvature::read_vertices(const Frame& frame) {
    if (frame.host_vertices.size() != vertex_count_)
        throw UsageError(fmt::format("curvature learned on a mesh sequence is that of {} vertices on the host, not {}",
                                     vertex_count_, frame.host_vertices.size()));
    reader_.read_surface(frame.host_vertices, {}, {}, x_);
    if (segments_.count() != 0) segments_.rotations_of_sequence(frame.host_vertices, rotations_);
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
