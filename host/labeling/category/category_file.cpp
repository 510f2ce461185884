// The file of a CategoryModel (docs/formats.md).

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "host/core/errors.h"
#include "host/core/json_text.h"
#include "host/data/model_file.h"
#include "host/data/safetensors.h"
#include "host/labeling/category/category_model.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

Json describe_category(const CategoryModel& model) {
    return {{"categories", model.category_names},
            {"samples", model.feature_options.samples},
            {"features", model.features},
            {"sharpness", model.sharpness},
            {"evidence_slope", model.confidence.slope},
            {"evidence_offset", model.confidence.offset},
            {"least_confidence", model.min_confidence},
            {"seed", model.seed},
            {"provenance", model.provenance}};
}

/// Reads a whole number. The JSON library alone would convert other values (-1, 1e300, true) to one.
std::uint64_t whole_value(const TensorFile& file, const Json& value) {
    if (!value.is_number_unsigned()) inconsistent(file, "its description has no whole number where one should be");
    return value.get<std::uint64_t>();
}

void read_category_description(const TensorFile& file, CategoryModel& model) {
    const Json json = parse_json(file.meta("model"));
    model.category_names = json.at("categories").get<std::vector<std::string>>();
    model.feature_options.samples = whole_value(file, json.at("samples"));
    model.features = json.at("features").get<std::vector<std::string>>();
    model.sharpness = json.at("sharpness").get<double>();
    model.confidence.slope = json.at("evidence_slope").get<double>();
    model.confidence.offset = json.at("evidence_offset").get<double>();
    model.min_confidence = json.at("least_confidence").get<double>();
    model.seed = whole_value(file, json.at("seed"));
    model.provenance = json.at("provenance").get<std::vector<std::string>>();
}

void check_category_description(const TensorFile& file, const CategoryModel& model) {
    try {
        require_category_names(model.category_names);
    } catch (const UsageError& error) {
        inconsistent(file, error.what());
    }
    if (model.feature_options.samples == 0 || model.feature_options.samples > k_max_samples)
        inconsistent(file, fmt::format("its features are of {} samples", model.feature_options.samples));
    if (model.features.empty()) inconsistent(file, "it has no features");
    if (std::ranges::any_of(model.features, is_appended))
        inconsistent(file, "it was trained with coordinates, which recognizers no longer take; train it again");
    if (!(model.sharpness > 0) || !std::isfinite(model.sharpness)) inconsistent(file, "its sharpness is not positive");
    if (!(model.confidence.slope >= 0) || !std::isfinite(model.confidence.slope) ||
        !std::isfinite(model.confidence.offset))
        inconsistent(file, "more evidence makes it less sure");
    if (!(model.min_confidence >= 0 && model.min_confidence <= 1))
        inconsistent(file, "its least confidence is not from 0 to 1");
}

std::vector<float> finite_array(const TensorFile& file, const std::string& name,
                                const std::vector<std::size_t>& shape) {
    std::vector<float> values = file.get<float>(name, shape);
    require_finite(file, name, values);
    return values;
}

}  // namespace

void require_category_names(std::span<const std::string> names) {
    if (names.size() < 2)
        throw UsageError(fmt::format("{}: a category is recognized beside others; give meshes of two at least",
                                     names.empty() ? "no categories" : "one category"));
    if (names.size() > k_max_categories)
        throw UsageError(fmt::format("{} categories; {} at most", names.size(), k_max_categories));
    for (auto name = names.begin(); name != names.end(); ++name) {
        if (!mesh_io::is_label_name(*name) || *name == k_unknown_category)
            throw UsageError(fmt::format("no category can be called {}; rename it", mesh_io::quote(*name)));
        if (std::find(names.begin(), name, *name) != name)
            throw UsageError(fmt::format("two categories are called {}; rename one", mesh_io::quote(*name)));
    }
}

void save_category_model(const std::filesystem::path& path, const CategoryModel& model) {
    TensorFile file;
    file.metadata["kind"] = k_category_model_kind;
    file.metadata["format_version"] = std::to_string(k_category_format_version);
    file.metadata["feature_version"] = std::to_string(k_feature_version);
    file.metadata["descriptor_version"] = std::to_string(k_shape_descriptor_version);
    file.metadata["model"] = json_text(describe_category(model));
    const std::size_t values = k_shape_statistics * model.features.size();
    file.add("mean", {values}, model.scores.mean);
    file.add("inverse_deviation", {values}, model.scores.inverse_deviation);
    file.add("weights", {model.category_count(), values}, model.scores.weights);
    file.add("offset", {model.category_count()}, model.scores.offset);
    write_safetensors(path, file);
}

CategoryModel load_category_model(const std::filesystem::path& path) {
    const TensorFile file = read_safetensors(path);
    if (const auto kind = file.metadata.find("kind");
        kind == file.metadata.end() || kind->second != k_category_model_kind)
        throw ModelError(
            fmt::format("{}: is no model of shape categories; make one with 'exemplar category train'", file.path));
    require_version(file, "format_version", k_category_format_version, "train it again");
    require_version(file, "feature_version", k_feature_version, "its features have changed: train it again");
    require_version(file, "descriptor_version", k_shape_descriptor_version,
                    "its descriptors have changed: train it again");
    CategoryModel model;
    try {
        read_category_description(file, model);
    } catch (const Json::exception&) {
        inconsistent(file, "its description cannot be read");
    }
    check_category_description(file, model);
    const std::size_t values = k_shape_statistics * model.features.size();
    model.scores.mean = finite_array(file, "mean", {values});
    model.scores.inverse_deviation = finite_array(file, "inverse_deviation", {values});
    if (std::ranges::any_of(model.scores.inverse_deviation, [](float d) { return d < 0; }))
        inconsistent(file, "a deviation is negative");
    model.scores.weights = finite_array(file, "weights", {model.category_count(), values});
    model.scores.offset = finite_array(file, "offset", {model.category_count()});
    return model;
}

}  // namespace exemplar
