// Writes model files.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "host/core/json_text.h"
#include "host/curvature/model/model.h"
#include "host/curvature/model/model_format.h"
#include "host/data/safetensors.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::uint32_t>;
using Floats = std::vector<float>;

Floats row_major(const Eigen::Ref<const Eigen::MatrixXf>& matrix) {
    Floats values;
    values.reserve(static_cast<std::size_t>(matrix.size()));
    for (Eigen::Index i = 0; i < matrix.rows(); ++i)
        for (Eigen::Index j = 0; j < matrix.cols(); ++j) values.push_back(matrix(i, j));
    return values;
}

Json describe(const CurvatureModel& model) {
    Json controls = Json::array();
    for (const Control& control : model.state.controls)
        controls.push_back({{"name", control.name}, {"inputs", control.input_count}});
    return {{"animation", static_cast<int>(model.kind)},
            {"attributes", static_cast<int>(model.tiles.set)},
            {"vertices", model.vertex_count},
            {"topology", fmt::format("{:016x}", model.topology)},
            {"smoothing", model.truth.smoothing},
            {"smoothing_unit", model.truth.smoothing_unit},
            {"robust", static_cast<int>(model.truth.robust)},
            {"feature_size", model.feature_size},
            {"controls", controls},
            {"training", model.training}};
}

template <typename Matrices>
Floats concatenated(const Matrices& parts) {
    Floats all;
    for (const auto& part : parts) {
        const Floats values = row_major(part);
        all.insert(all.end(), values.begin(), values.end());
    }
    return all;
}

/// Returns this kind of a state, empty if the state is of another kind.
template <typename Kind>
const Kind& kind_of(const StateReader& state) {
    static const Kind k_other;
    const Kind* const kind = std::get_if<Kind>(&state.source);
    return kind ? *kind : k_other;
}

/// Writes the arrays of all kinds of state, those of other kinds empty.
void add_state(TensorFile& file, const StateReader& state) {
    const auto& joints = kind_of<JointState>(state);
    const auto& bending = kind_of<HingeState>(state);
    const auto& local = kind_of<LocalShapeState>(state);
    const std::span<const std::uint32_t> nodes = state.parts_of_rig();
    Floats reference;
    for (const Eigen::Quaternionf& q : joints.reference)
        reference.insert(reference.end(), {q.x(), q.y(), q.z(), q.w()});
    file.add("state.nodes", {nodes.size()}, Words(nodes.begin(), nodes.end()));
    file.add("state.reference", {joints.reference.size(), 4}, reference);
    Words hinges;
    for (const Hinge& h : bending.hinges) hinges.insert(hinges.end(), {h.a, h.b, h.left, h.right});
    file.add("state.hinges", {bending.hinges.size(), 4}, hinges);
    file.add("state.hinge_begin", {bending.begin.size()}, bending.begin);
    file.add("state.mean_angles", {bending.hinges.size()}, row_major(bending.mean));
    const Floats unmixing = concatenated(bending.unmixing), map = concatenated(local.map),
                 mean = concatenated(local.mean);
    std::vector<Half> halves;
    std::transform(map.begin(), map.end(), std::back_inserter(halves), to_half);
    file.add("state.unmixing", {unmixing.size()}, unmixing);
    file.add("state.local_map", {halves.size()}, halves);
    file.add("state.local_begin", {local.begin.size()}, local.begin);
    file.add("state.local_vertex", {local.vertex.size()}, local.vertex);
    file.add("state.local_mean", {mean.size()}, mean);
    file.add("state.local_unit", {1}, Floats{local.unit});
}

void add_range(TensorFile& file, const PoseRange& range) {
    const Floats whitening = concatenated(range.whitening);
    file.add("range.mean", {static_cast<std::size_t>(range.mean.size())}, row_major(range.mean));
    file.add("range.whitening", {whitening.size()}, whitening);
    file.add("range.largest", {range.largest.size()}, range.largest);
}

void add_segments(TensorFile& file, const Segments& segments) {
    Words bones, patches;
    Floats weights;
    for (const Influence& influence : segments.influences) {
        bones.push_back(influence.bone);
        weights.push_back(influence.weight);
    }
    for (const Segments::Triangle& triangle : segments.triangles)
        for (const auto& patch : triangle.patches) patches.insert(patches.end(), patch.begin(), patch.end());
    file.add("segments.influence_begin", {segments.influence_begin.size()}, segments.influence_begin);
    file.add("segments.bone", {bones.size()}, bones);
    file.add("segments.weight", {weights.size()}, weights);
    file.add("segments.patches", {segments.triangles.size(), 3, Segments::Triangle::k_patch}, patches);
}

void add_regression(TensorFile& file, const ComponentRegression& regression) {
    Words monomials, components;
    for (const Monomial& m : regression.monomials) monomials.insert(monomials.end(), m.begin(), m.end());
    for (const ComponentRegression::Component& c : regression.components)
        components.insert(components.end(), {c.first_feature, c.feature_count, c.first_coefficient});
    const auto neurons = static_cast<std::size_t>(regression.neurons.rows());
    file.add("regression.monomials", {regression.monomials.size(), 3}, monomials);
    file.add("regression.neurons", {neurons, regression.input_count}, row_major(regression.neurons));
    file.add("regression.neuron_bias", {neurons}, row_major(regression.neuron_bias));
    file.add("regression.components", {regression.components.size(), 3}, components);
    file.add("regression.coefficients", {regression.coefficients.size()}, regression.coefficients);
}

void add_tiles(TensorFile& file, const BasisTiles& tiles) {
    const std::size_t count = tiles.tile_count(), lanes = BasisTiles::k_lanes;
    file.add("tiles.vertex", {count, lanes}, tiles.vertex);
    file.add("tiles.segment", {count}, tiles.segment);
    file.add("tiles.scale", {tiles.scale.size()}, tiles.scale);
    file.add("tiles.entry_begin", {tiles.entry_begin.size()}, tiles.entry_begin);
    file.add("tiles.entry", {tiles.entry.size()}, tiles.entry);
    file.add("tiles.basis", {tiles.entry.size(), lanes}, tiles.basis);
    file.add("tiles.mean", {count, tiles.scale.size(), lanes}, tiles.mean);
    const bool tensor = tiles.set == AttributeSet::tensor;
    file.add("tiles.neighbor", {tensor ? count : 0, lanes}, tiles.neighbor);
    file.add("tiles.reference", {tensor ? 0 : count, 3, lanes}, tiles.reference);
}

}  // namespace

void save_curvature_model(const std::filesystem::path& path, const CurvatureModel& model) {
    TensorFile file;
    file.metadata["kind"] = k_model_kind;
    file.metadata["format_version"] = std::to_string(k_model_version);
    file.metadata["model"] = json_text(describe(model));
    add_state(file, model.state);
    add_range(file, model.range);
    add_segments(file, model.segments);
    add_regression(file, model.regression);
    add_tiles(file, model.tiles);
    write_safetensors(path, file);
}

}  // namespace exemplar
