#include "gpu/curvature/learned/local_state.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "embedded/curvature_local_state_comp.h"
#include "embedded/curvature_patch_rotations_comp.h"
#include "gpu/curvature/learned/row_threads.h"
#include "gpu/curvature/surface/texels.h"
#include "host/core/errors.h"
#include "host/core/half.h"
#include "shaders/shared/curvature.h"

namespace exemplar {
namespace {

using shared::LocalInput;
using shared::LocalInputParameters;
using shared::PatchParameters;
using shared::uvec4;
using shared::vec4;

// The kernel fetches it as one four-component vector.
static_assert(sizeof(LocalInput) == 16);
static_assert(shared::k_corner_vertices == Segments::Triangle::k_patch && shared::k_corner_vertices % 4 == 0);
static_assert(LocalShapeState::k_numbers == 4);  // a texel of halves has two vertices

/// Returns the state of a model after checking that all of it fits together.
const LocalShapeState& checked_state(const CurvatureModel& model) {
    const std::vector<Control>& controls = model.state.controls;
    const std::size_t patches = controls.size();
    const auto* const local = std::get_if<LocalShapeState>(&model.state.source);
    bool fits = local && local->begin.size() == patches + 1 && model.segments.triangles.size() == patches &&
                local->map.size() == patches && local->mean.size() == patches;
    for (std::size_t p = 0; fits && p < patches; ++p)
        fits = local->map[p].rows() == Eigen::Index{controls[p].input_count} &&
               local->map[p].cols() == static_cast<Eigen::Index>(local->size(p)) &&
               local->mean[p].size() == static_cast<Eigen::Index>(local->size(p));
    if (!fits) throw ModelError("a curvature model is damaged: its patches contradict each other; train it again");
    return *local;
}

std::vector<std::uint32_t> corner_vertices(const Segments& segments) {
    std::vector<std::uint32_t> vertices;
    for (const Segments::Triangle& triangle : segments.triangles)
        for (const auto& corner : triangle.patches) vertices.insert(vertices.end(), corner.begin(), corner.end());
    return vertices;
}

// Appends a row of a control's map, a texel per two vertices.
void append_weights(const Eigen::Ref<const Eigen::RowVectorXf>& row, std::vector<uvec4>& texels) {
    const auto word = [&](Eigen::Index at) {
        if (at >= row.size()) return std::uint32_t{0};
        return std::uint32_t{to_half(row[at]).bits} | std::uint32_t{to_half(row[at + 1]).bits} << 16;
    };
    for (Eigen::Index at = 0; at < row.size(); at += 2 * LocalShapeState::k_numbers)
        texels.push_back({word(at), word(at + 2), word(at + 4), word(at + 6)});
}

struct LocalInputs {
    std::vector<LocalInput> table;
    std::vector<uvec4> weights;
    std::vector<float> biases;
};

LocalInputs gather_inputs(const LocalShapeState& state, const PoseRange& range) {
    LocalInputs result;
    for (std::uint32_t p = 0; p < state.map.size(); ++p) {
        const Eigen::MatrixXf& map = state.map[p];
        const std::uint32_t first = state.begin[p], count = state.begin[p + 1] - first;
        for (Eigen::Index i = 0; i < map.rows(); ++i) {
            result.table.push_back({p, first, count, static_cast<std::uint32_t>(result.weights.size())});
            result.biases.push_back(-map.row(i).dot(state.mean[p]) -
                                    range.mean[static_cast<Eigen::Index>(result.biases.size())]);
            append_weights(map.row(i), result.weights);
        }
    }
    return result;
}

}  // namespace

GpuLocalState::GpuLocalState(Device& device, const CurvatureModel& model, std::size_t padded_inputs)
    : patch_count_(model.state.controls.size()),
      input_count_(model.state.input_count),
      input_threads_(row_threads(device, input_count_)),
      unit_(checked_state(model).unit),
      rotation_kernel_(device, shaders::curvature_patch_rotations_comp,
                       {.push_constants = layout_of<PatchParameters>(),
                        .elements = {layout_of<uvec4>(), layout_of<vec4>(), layout_of<vec4>()}}),
      input_kernel_(
          device, shaders::curvature_local_state_comp,
          {.push_constants = layout_of<LocalInputParameters>(),
           .elements = {layout_of<uvec4>(), layout_of<std::uint32_t>(), layout_of<uvec4>(), layout_of<float>(),
                        layout_of<vec4>(), layout_of<vec4>(), layout_of<vec4>(), layout_of<float>()}}) {
    const LocalShapeState& state = checked_state(model);
    const LocalInputs inputs = gather_inputs(state, model.range);
    check_texels(device, std::max({inputs.weights.size(), state.vertex.size(), 6 * patch_count_}),
                 "the patches of a curvature model");
    corners_ = Buffer::of<std::uint32_t>(device, corner_vertices(model.segments));
    table_ = Buffer::of<LocalInput>(device, inputs.table);
    members_ = Buffer::of<std::uint32_t>(device, state.vertex);
    weights_ = Buffer::of<uvec4>(device, inputs.weights);
    biases_ = Buffer::of<float>(device, inputs.biases);
    rotations_ = Buffer(device, 3 * patch_count_ * sizeof(vec4));
    std::vector<float> padding(padded_inputs, 0.0f);
    padding[input_count_] = 1.0f;
    inputs_ = Buffer::of<float>(device, padding);
}

void GpuLocalState::record(Stream& stream, const Buffer& vertices, const Buffer& normals) {
    stream.dispatch(rotation_kernel_, patch_count_, {corners_, vertices, rotations_},
                    PatchParameters{static_cast<std::uint32_t>(patch_count_)});
    stream.dispatch(input_kernel_, input_threads_,
                    {table_, members_, weights_, biases_, rotations_, vertices, normals, inputs_},
                    LocalInputParameters{static_cast<std::uint32_t>(input_count_), 1.0f / unit_});
}

}  // namespace exemplar
