// Reads model files.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "host/core/errors.h"
#include "host/core/json_text.h"
#include "host/curvature/model/model.h"
#include "host/curvature/model/model_format.h"
#include "host/data/safetensors.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;
using Words = std::vector<std::uint32_t>;
using Floats = std::vector<float>;

constexpr std::size_t k_any = TensorFile::k_any;

Eigen::MatrixXf matrix_of(const Floats& values, std::size_t rows, std::size_t columns) {
    return Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        values.data(), static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
}

Floats part_of(const Floats& values, std::size_t first, std::size_t count) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
    return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

Eigen::VectorXf vector_of(const Floats& values) {
    return Eigen::Map<const Eigen::VectorXf>(values.data(), static_cast<Eigen::Index>(values.size()));
}

Floats as_floats(const std::vector<Half>& halves) {
    Floats values(halves.size());
    std::transform(halves.begin(), halves.end(), values.begin(), from_half);
    return values;
}

/// A file being read, with checks that throw ModelError. Every index is checked to be in range.
struct Reading {
    const TensorFile& file;
    mutable std::size_t arrays = 0;  ///< number of arrays read, each once

    [[noreturn]] void damaged(const std::string& what) const {
        throw ModelError(fmt::format("{}: damaged file: {}; train it again", file.path, what));
    }
    void require(bool holds, const char* what) const {
        if (!holds) damaged(what);
    }
    template <typename T>
    std::vector<T> get(const std::string& name, const std::vector<std::size_t>& shape) const {
        ++arrays;
        return file.get<T>(name, shape);
    }
    Words words(const std::string& name, const std::vector<std::size_t>& shape) const {
        return get<std::uint32_t>(name, shape);
    }
    Floats floats(const std::string& name, const std::vector<std::size_t>& shape) const {
        Floats values = get<float>(name, shape);
        if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
            damaged(name + " holds a value that is not finite");
        return values;
    }
    std::vector<Half> halves(const std::string& name, const std::vector<std::size_t>& shape) const {
        std::vector<Half> values = get<Half>(name, shape);
        constexpr std::uint16_t k_exponent = 0x7C00;
        if (std::any_of(values.begin(), values.end(), [](Half h) { return (h.bits & k_exponent) == k_exponent; }))
            damaged(name + " holds a value that is not finite");
        return values;
    }
    void below(const Words& values, std::size_t bound, const char* name) const {
        for (const std::uint32_t value : values)
            if (value >= bound) damaged(fmt::format("{} names {} of {}", name, value, bound));
    }
    void rows(const Words& begin, std::size_t count, std::size_t end, const char* name) const {
        if (begin.empty() || begin.size() != count + 1 || begin.front() != 0 || begin.back() != end ||
            !std::is_sorted(begin.begin(), begin.end()))
            damaged(fmt::format("{} are no rows", name));
    }
};

/// Returns a whole number of at most `most`. The JSON library would silently convert -1, 1e300 or true.
std::uint64_t whole_number(const Reading& reading, const Json& value, std::uint64_t most) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
        reading.damaged("its description has another value where a whole number should be");
    return value.get<std::uint64_t>();
}

std::uint64_t topology_of(const Reading& reading, const std::string& digits) {
    std::uint64_t value = 0;
    const char* const last = digits.data() + digits.size();
    const auto [end, error] = std::from_chars(digits.data(), last, value, 16);
    reading.require(digits.size() == 16 && end == last && error == std::errc(), "its topology is not 16 digits");
    return value;
}

void read_description(const Reading& reading, CurvatureModel& model) {
    const Json json = parse_json(reading.file.meta("model"));
    model.kind = static_cast<AnimationKind>(whole_number(reading, json.at("animation"), 2));
    model.tiles.set = static_cast<AttributeSet>(whole_number(reading, json.at("attributes"), 1));
    model.vertex_count = whole_number(reading, json.at("vertices"), 0xFFFFFFFEu);
    model.topology = topology_of(reading, json.at("topology").get<std::string>());
    model.truth.smoothing = json.at("smoothing");
    model.truth.smoothing_unit = json.at("smoothing_unit");
    model.truth.robust = static_cast<RobustEstimator>(whole_number(reading, json.at("robust"), 2));
    model.feature_size = json.at("feature_size");
    for (const Json& control : json.at("controls")) {
        const auto inputs = static_cast<std::uint32_t>(whole_number(reading, control.at("inputs"), 100'000));
        model.state.controls.push_back(
            {control.at("name"), static_cast<std::uint32_t>(model.state.input_count), inputs});
        model.state.input_count += inputs;
    }
    model.training = json.at("training").get<std::map<std::string, std::string>>();
    for (const double value : {model.truth.smoothing, model.truth.smoothing_unit, double(model.feature_size)})
        reading.require(value >= 0 && std::isfinite(value), "a length in its description is negative");
}

/// Splits concatenated maps of the controls to their inputs; columns(c) is the width of that of control c.
template <typename Columns>
std::vector<Eigen::MatrixXf> split_maps(const Reading& reading, const Floats& all, const std::vector<Control>& controls,
                                        Columns&& columns) {
    std::vector<Eigen::MatrixXf> maps;
    std::size_t at = 0;
    for (std::size_t c = 0; c < controls.size(); ++c) {
        const std::size_t rows = controls[c].input_count, width = columns(c);
        reading.require(rows * width <= all.size() - at, "its map to the inputs is too short");
        maps.push_back(matrix_of(part_of(all, at, rows * width), rows, width));
        at += rows * width;
    }
    reading.require(at == all.size(), "its map to the inputs is too long");
    return maps;
}

void read_rig_parts(const Reading& reading, bool is_rig, AnimationKind kind, StateReader& state) {
    const bool turns = is_rig && kind == AnimationKind::skeleton;
    Words parts = reading.words("state.nodes", {is_rig ? state.controls.size() : 0});
    const Floats reference = reading.floats("state.reference", {turns ? state.controls.size() : 0, 4});
    if (!is_rig) return;
    for (const Control& control : state.controls)
        reading.require(control.input_count == (turns ? 3u : 1u), "a control has a wrong number of inputs");
    if (!turns) {
        state.source = WeightState{std::move(parts)};
        return;
    }
    JointState joints{std::move(parts), {}};
    for (std::size_t i = 0; i + 3 < reference.size(); i += 4)
        joints.reference.emplace_back(reference[i + 3], reference[i], reference[i + 1], reference[i + 2]);
    state.source = std::move(joints);
}

void read_hinges(const Reading& reading, bool bends, std::size_t vertex_count, StateReader& state) {
    HingeState bending;
    const Words hinges = reading.words("state.hinges", {bends ? k_any : 0, 4});
    reading.below(hinges, vertex_count, "state.hinges");
    for (std::size_t i = 0; i < hinges.size(); i += 4)
        bending.hinges.push_back({hinges[i], hinges[i + 1], hinges[i + 2], hinges[i + 3]});
    bending.mean = vector_of(reading.floats("state.mean_angles", {bending.hinges.size()}));
    bending.begin = reading.words("state.hinge_begin", {bends ? state.controls.size() + 1 : 0});
    const Floats unmixing = reading.floats("state.unmixing", {bends ? k_any : 0});
    if (!bends) return;
    reading.rows(bending.begin, state.controls.size(), bending.hinges.size(), "the hinges of the patches");
    bending.unmixing = split_maps(reading, unmixing, state.controls,
                                  [&](std::size_t c) { return bending.begin[c + 1] - bending.begin[c]; });
    state.source = std::move(bending);
}

void read_local_shape(const Reading& reading, bool is_local, std::size_t vertex_count, StateReader& state) {
    LocalShapeState local;
    local.begin = reading.words("state.local_begin", {is_local ? state.controls.size() + 1 : 0});
    local.vertex = reading.words("state.local_vertex", {is_local ? k_any : 0});
    local.unit = reading.floats("state.local_unit", {1})[0];
    const Floats mean = reading.floats("state.local_mean", {LocalShapeState::k_numbers * local.vertex.size()});
    const Floats map = as_floats(reading.halves("state.local_map", {is_local ? k_any : 0}));
    if (!is_local) {
        reading.require(local.unit == LocalShapeState().unit, "state.local_unit is of another kind of state");
        return;
    }
    reading.rows(local.begin, state.controls.size(), local.vertex.size(), "the vertices of the patches");
    reading.below(local.vertex, vertex_count, "state.local_vertex");
    reading.require(local.unit > 0, "state.local_unit is not positive");
    for (std::size_t c = 0; c < state.controls.size(); ++c)
        local.mean.push_back(vector_of(part_of(mean, LocalShapeState::k_numbers * local.begin[c], local.size(c))));
    local.map = split_maps(reading, map, state.controls, [&](std::size_t c) { return local.size(c); });
    state.source = std::move(local);
}

/// Reads the arrays of all kinds of state; those of other kinds must be as they are written, empty or 1.
void read_state(const Reading& reading, CurvatureModel& model) {
    const bool is_local = !reading.file.get<std::uint32_t>("state.local_begin", {k_any}).empty();
    const bool is_sequence = model.kind == AnimationKind::sequence;
    read_rig_parts(reading, !is_local && !is_sequence, model.kind, model.state);
    read_hinges(reading, !is_local && is_sequence, model.vertex_count, model.state);
    read_local_shape(reading, is_local, model.vertex_count, model.state);
}

void read_range(const Reading& reading, CurvatureModel& model) {
    model.range.mean = vector_of(reading.floats("range.mean", {model.state.input_count}));
    model.range.largest = reading.floats("range.largest", {model.state.controls.size()});
    const Floats whitening = reading.floats("range.whitening", {k_any});
    std::size_t at = 0;
    for (const Control& control : model.state.controls) {
        if (model.state.is_local()) break;
        const std::size_t n = control.input_count;
        reading.require(n * n <= whitening.size() - at, "range.whitening is too short");
        model.range.whitening.push_back(matrix_of(part_of(whitening, at, n * n), n, n));
        at += n * n;
    }
    reading.require(at == whitening.size(), "range.whitening is too long");
    for (const float largest : model.range.largest) reading.require(largest > 0, "range.largest is not positive");
}

void read_segments(const Reading& reading, CurvatureModel& model) {
    Segments& segments = model.segments;
    const bool is_rig = model.state.is_of_rig(), principal = model.tiles.set == AttributeSet::principal;
    const bool has_bones = is_rig && principal, has_patches = !is_rig && (principal || model.state.is_local());
    segments.influence_begin = reading.words("segments.influence_begin", {has_bones ? k_any : 0});
    const Words bones = reading.words("segments.bone", {has_bones ? k_any : 0});
    const Floats weights = reading.floats("segments.weight", {bones.size()});
    for (std::size_t i = 0; i < bones.size(); ++i) segments.influences.push_back({bones[i], weights[i]});
    if (has_bones)
        reading.rows(segments.influence_begin, std::max<std::size_t>(segments.influence_begin.size(), 1) - 1,
                     bones.size(), "the segments");
    const Words patches = reading.words("segments.patches", {has_patches ? k_any : 0, 3, Segments::Triangle::k_patch});
    reading.below(patches, model.vertex_count, "segments.patches");
    const std::size_t count = patches.size() / (3 * Segments::Triangle::k_patch);
    reading.require(!model.state.is_local() || count == model.state.controls.size(), "patches and segments differ");
    for (std::size_t s = 0; s < count; ++s) {
        Segments::Triangle triangle;
        for (std::size_t i = 0; i < 3; ++i)
            std::copy_n(patches.begin() + static_cast<std::ptrdiff_t>((3 * s + i) * Segments::Triangle::k_patch),
                        Segments::Triangle::k_patch, triangle.patches[i].begin());
        segments.triangles.push_back(triangle);
    }
}

void read_regression(const Reading& reading, CurvatureModel& model) {
    ComponentRegression& regression = model.regression;
    regression.input_count = model.state.input_count;
    const Words monomials = reading.words("regression.monomials", {k_any, 3});
    reading.below(monomials, regression.input_count + 1, "regression.monomials");
    for (std::size_t i = 0; i < monomials.size(); i += 3)
        regression.monomials.push_back({monomials[i], monomials[i + 1], monomials[i + 2]});
    regression.neuron_bias = vector_of(reading.floats("regression.neuron_bias", {k_any}));
    const auto neurons = static_cast<std::size_t>(regression.neuron_bias.size());
    regression.neurons = matrix_of(reading.floats("regression.neurons", {neurons, regression.input_count}), neurons,
                                   regression.input_count);
    regression.coefficients = reading.floats("regression.coefficients", {k_any});
    const Words components = reading.words("regression.components", {k_any, 3});
    std::size_t coefficients = 0;
    for (std::size_t i = 0; i < components.size(); i += 3) {
        const std::uint64_t first = components[i], count = components[i + 1];
        reading.require(first + count <= regression.feature_count(), "a component uses features that are not there");
        reading.require(components[i + 2] == coefficients && count <= regression.coefficients.size() - coefficients,
                        "a component has not the coefficients that follow those of the one before");
        coefficients += count;
        regression.components.push_back({components[i], components[i + 1], components[i + 2]});
    }
    reading.require(coefficients == regression.coefficients.size(), "coefficients are listed for no component");
}

void read_tiles(const Reading& reading, CurvatureModel& model) {
    BasisTiles& tiles = model.tiles;
    const std::size_t lanes = BasisTiles::k_lanes, attributes = attribute_count(tiles.set);
    tiles.vertex_count = model.vertex_count;
    tiles.segment = reading.words("tiles.segment", {k_any});
    const std::size_t count = tiles.segment.size();
    const bool tensor = tiles.set == AttributeSet::tensor;
    const std::size_t segments = model.segments.count();
    reading.below(tiles.segment, tensor ? std::max<std::size_t>(segments, 1) : segments, "tiles.segment");
    const auto last = std::max_element(tiles.segment.begin(), tiles.segment.end());
    reading.require(model.segments.triangles.empty() ||
                        (last != tiles.segment.end() && *last + 1 == model.segments.triangles.size()),
                    "a segment has no tile");
    tiles.vertex = reading.words("tiles.vertex", {count, lanes});
    reading.below(tiles.vertex, model.vertex_count, "tiles.vertex");
    tiles.scale = reading.floats("tiles.scale", {attributes});
    tiles.entry = reading.words("tiles.entry", {k_any});
    for (const std::uint32_t entry : tiles.entry) {
        reading.require(BasisTiles::component_of(entry) < model.regression.components.size(),
                        "a tile uses a component that is not there");
        reading.require(std::isfinite(BasisTiles::step_of(entry)), "tiles.entry holds a step that is not finite");
    }
    tiles.entry_begin = reading.words("tiles.entry_begin", {k_any});
    reading.rows(tiles.entry_begin, count * attributes, tiles.entry.size(), "the entries of the tiles");
    tiles.basis = reading.get<std::int8_t>("tiles.basis", {tiles.entry.size(), lanes});
    tiles.mean = reading.halves("tiles.mean", {count, attributes, lanes});
    tiles.neighbor = reading.words("tiles.neighbor", {tensor ? count : 0, lanes});
    reading.below(tiles.neighbor, model.vertex_count, "tiles.neighbor");
    tiles.reference = reading.halves("tiles.reference", {tensor ? 0 : count, 3, lanes});
    reading.require(model.vertex_count <= tiles.vertex.size(), "a vertex is in no tile");
    std::vector<bool> seen(model.vertex_count, false);
    for (const std::uint32_t v : tiles.vertex) seen[v] = true;
    reading.require(std::find(seen.begin(), seen.end(), false) == seen.end(), "a vertex is in no tile");
}

void require_version(const TensorFile& file) {
    const auto kind = file.metadata.find("kind");
    if (kind == file.metadata.end() || kind->second != k_model_kind)
        throw ModelError(fmt::format("{}: is no curvature model; make one with 'exemplar curvature train'", file.path));
    const std::string& version = file.meta("format_version");
    if (version != std::to_string(k_model_version))
        throw ModelError(fmt::format("{}: its format has version {}, this program knows {}; train it again", file.path,
                                     version.substr(0, 20), k_model_version));
}

}  // namespace

CurvatureModel load_curvature_model(const std::filesystem::path& path) {
    const TensorFile file = read_safetensors(path);
    require_version(file);
    const Reading reading{file};
    CurvatureModel model;
    try {
        read_description(reading, model);
    } catch (const Json::exception&) {
        reading.damaged("its description cannot be read");
    }
    read_state(reading, model);
    read_range(reading, model);
    read_segments(reading, model);
    read_regression(reading, model);
    read_tiles(reading, model);
    reading.require(reading.arrays == file.tensors.size(), "it has arrays of no meaning");
    return model;
}

}  // namespace exemplar
