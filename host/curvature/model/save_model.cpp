// Writes model files.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

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

void add_state(TensorFile& file, const StateReader& state) {
    Floats reference;
    for (const Eigen::Quaternionf& q : state.reference) reference.insert(reference.end(), {q.x(), q.y(), q.z(), q.w()});
    file.add("state.nodes", {state.nodes.size()}, state.nodes);
    file.add("state.reference", {state.reference.size(), 4}, reference);
    Words hinges;
    for (const StateReader::Hinge& h : state.hinges) hinges.insert(hinges.end(), {h.a, h.b, h.left, h.right});
    file.add("state.hinges", {state.hinges.size(), 4}, hinges);
    file.add("state.hinge_begin", {state.hinge_begin.size()}, state.hinge_begin);
    file.add("state.mean_angles", {state.hinges.size()}, row_major(state.mean_angles));
    Floats unmixing;
    for (const Eigen::MatrixXf& part : state.unmixing) {
        const Floats values = row_major(part);
        unmixing.insert(unmixing.end(), values.begin(), values.end());
    }
    std::vector<Half> local_map;
    if (state.is_local()) {
        std::transform(unmixing.begin(), unmixing.end(), std::back_inserter(local_map), to_half);
        unmixing.clear();
    }
    file.add("state.unmixing", {unmixing.size()}, unmixing);
    file.add("state.local_map", {local_map.size()}, local_map);
    Floats local_mean;
    for (const Eigen::VectorXf& part : state.local_mean) local_mean.insert(local_mean.end(), part.begin(), part.end());
    file.add("state.local_begin", {state.local_begin.size()}, state.local_begin);
    file.add("state.local_vertex", {state.local_vertex.size()}, state.local_vertex);
    file.add("state.local_mean", {local_mean.size()}, local_mean);
    file.add("state.local_unit", {1}, Floats{state.local_unit});
}

void add_range(TensorFile& file, const PoseRange& range) {
    Floats whitening;
    for (const Eigen::MatrixXf& part : range.whitening) {
        const Floats values = row_major(part);
        whitening.insert(whitening.end(), values.begin(), values.end());
    }
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
    file.metadata["model"] = describe(model).dump(-1, ' ', false, Json::error_handler_t::replace);
    add_state(file, model.state);
    add_range(file, model.range);
    add_segments(file, model.segments);
    add_regression(file, model.regression);
    add_tiles(file, model.tiles);
    write_safetensors(path, file);
}

}  // namespace exemplar
