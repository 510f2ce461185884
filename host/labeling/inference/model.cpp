#include "host/labeling/inference/model.h"

#include <fmt/format.h>
#include <algorithm>

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/core/errors.h"
#include "host/core/json_text.h"
#include "host/data/model_file.h"
#include "host/data/safetensors.h"
#include "host/labeling/inference/mesh_turn.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

constexpr const char* k_kind = "exemplar mesh labeling";
constexpr std::size_t k_max_stages = 64;  ///< bounds against absurd files
constexpr float k_max_score = 1e30F;

Json describe_model(const LabelingModel& model) {
    Json colors = Json::array();
    for (const Color& color : model.label_colors) colors.push_back({color[0], color[1], color[2]});
    return {{"labels", model.label_names},
            {"colors", colors},
            {"samples", model.feature_options.samples},
            {"unary_features", model.unary_names},
            {"pairwise_features", model.pairwise_names},
            {"unary_stages", model.unary.size()},
            {"averaged_labels", model.averaged_labels},
            {"pairwise_stages", model.pairwise.size()},
            {"kappa", model.crf.kappa},
            {"lambda", model.crf.lambda},
            {"mu", model.crf.mu},
            {"compatibility", model.crf.compatibility},
            {"merge_fraction", model.crf.merge_fraction},
            {"seed", model.seed},
            {"provenance", model.provenance}};
}

/// Reads a whole number. The JSON library alone would convert other values (-1, 1e300, true) to one.
std::uint64_t whole_number(const TensorFile& file, const Json& value, std::uint64_t most = ~std::uint64_t{0}) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
        inconsistent(file, "its description has another value where a whole number should be");
    return value.get<std::uint64_t>();
}

Color color_of(const TensorFile& file, const Json& channels) {
    Color color;
    for (std::size_t i = 0; i < color.size(); ++i)
        color[i] = static_cast<std::uint8_t>(whole_number(file, channels.at(i), 255));
    return color;
}

void read_model_description(const TensorFile& file, LabelingModel& model) {
    const Json json = parse_json(file.meta("model"));
    model.label_names = json.at("labels").get<std::vector<std::string>>();
    for (const Json& color : json.at("colors")) model.label_colors.push_back(color_of(file, color));
    model.feature_options.samples = whole_number(file, json.at("samples"));
    model.unary_names = json.at("unary_features").get<std::vector<std::string>>();
    model.pairwise_names = json.at("pairwise_features").get<std::vector<std::string>>();
    model.unary.resize(std::min<std::size_t>(whole_number(file, json.at("unary_stages")), k_max_stages));
    model.pairwise.resize(std::min<std::size_t>(whole_number(file, json.at("pairwise_stages")), k_max_stages));
    const Json averaged = json.value("averaged_labels", Json::array());  // older models have none
    if (!averaged.is_array()) inconsistent(file, "its averaged labels are no list");
    for (const Json& label : averaged)
        model.averaged_labels.push_back(static_cast<std::uint32_t>(whole_number(file, label, model.class_count() - 1)));
    model.crf.kappa = json.at("kappa");
    model.crf.lambda = json.at("lambda");
    model.crf.mu = json.at("mu");
    model.crf.compatibility = json.at("compatibility").get<std::vector<double>>();
    model.crf.merge_fraction = json.at("merge_fraction");
    model.seed = whole_number(file, json.at("seed"));
    model.provenance = json.at("provenance").get<std::vector<std::string>>();
}

void check_model_description(const TensorFile& file, const LabelingModel& model) {
    const std::size_t classes = model.class_count();
    if (classes == 0 || classes > k_max_classes) inconsistent(file, fmt::format("it has {} labels", classes));
    for (const std::string& name : model.label_names)
        if (!mesh_io::is_label_name(name)) inconsistent(file, "no label can have the name " + mesh_io::quote(name));
    for (auto label = model.averaged_labels.begin(); label != model.averaged_labels.end(); ++label)
        if (std::find(model.averaged_labels.begin(), label, *label) != label)
            inconsistent(file, "an averaged label is there twice");
    if (model.label_colors.size() != classes) inconsistent(file, "labels and colors differ in number");
    if (model.crf.compatibility.size() != classes * classes)
        inconsistent(file, "the label compatibility has the wrong size");
    for (const double value : model.crf.compatibility)
        if (!(value >= 0)) inconsistent(file, "the label compatibility is negative");
    for (const double weight : {model.crf.kappa, model.crf.lambda, model.crf.mu, model.crf.merge_fraction})
        if (!(weight >= 0) || !std::isfinite(weight)) inconsistent(file, "a weight of the label cut is negative");
    if (model.feature_options.samples == 0 || model.feature_options.samples > k_max_samples)
        inconsistent(file, fmt::format("its features are of {} samples", model.feature_options.samples));
    if (model.unary.empty()) inconsistent(file, "it has no classifier");
}

/// Arrays NAME.mean, .inverse, .weight, .constant and .ratio_scale (docs/formats.md).
void add_linear(TensorFile& file, const std::string& name, const LinearExpert& expert) {
    const LinearClassifier& linear = expert.classifier;
    file.add(name + ".mean", {linear.feature_count()}, linear.mean);
    file.add(name + ".inverse", {linear.feature_count()}, linear.inverse);
    file.add(name + ".weight", {linear.feature_count(), linear.class_count}, linear.weight);
    file.add(name + ".constant", {linear.class_count}, linear.constant);
    file.add(name + ".ratio_scale", {2}, std::vector<float>{expert.ratio, expert.scale});
}

/// Returns an upper bound of |L| for any features.
float largest_score(const LinearClassifier& linear) {
    float sum = 0;
    for (const float weight : linear.weight) sum += LinearClassifier::k_max_deviations * std::abs(weight);
    for (const float constant : linear.constant) sum += std::abs(constant);
    return sum;
}

/// Returns the linear classifier of this name; one that is not used if the file has none.
LinearExpert find_linear(const TensorFile& file, const std::string& name, std::size_t classes, std::size_t features) {
    LinearExpert expert;
    if (!file.tensors.contains(name + ".weight")) return expert;
    LinearClassifier& linear = expert.classifier;
    linear.class_count = static_cast<std::uint32_t>(classes);
    linear.mean = file.get<float>(name + ".mean", {features});
    linear.inverse = file.get<float>(name + ".inverse", {features});
    linear.weight = file.get<float>(name + ".weight", {features, classes});
    linear.constant = file.get<float>(name + ".constant", {classes});
    const auto ratio_scale = file.get<float>(name + ".ratio_scale", {2});
    for (const auto* values : {&std::as_const(linear.mean), &std::as_const(linear.inverse),
                               &std::as_const(linear.weight), &std::as_const(linear.constant), &ratio_scale})
        require_finite(file, name, *values);
    expert.ratio = ratio_scale[0], expert.scale = ratio_scale[1];
    if (!(expert.ratio >= 0) || !(expert.scale > 0)) inconsistent(file, name + ".ratio_scale is negative");
    if (!(expert.scale * (expert.ratio * largest_score(linear) + 1) < k_max_score))
        inconsistent(file, name + " has weights so large that scores are not finite");
    return expert;
}

}  // namespace

void save_model(const std::filesystem::path& path, const LabelingModel& model) {
    TensorFile file;
    file.metadata["kind"] = k_kind;
    file.metadata["format_version"] = std::to_string(k_model_format_version);
    file.metadata["feature_version"] = std::to_string(k_feature_version);
    file.metadata["model"] = json_text(describe_model(model));
    for (std::size_t s = 0; s < model.unary.size(); ++s)
        add_classifier(file, fmt::format("unary.{}", s), model.unary[s]);
    for (std::size_t s = 0; s < model.linear.size(); ++s)
        if (model.linear[s].used()) add_linear(file, fmt::format("linear.{}", s), model.linear[s]);
    if (uses_orientation(model)) {
        add_classifier(file, "unoriented", model.unoriented);
        if (model.unoriented_linear.used()) add_linear(file, "unoriented.linear", model.unoriented_linear);
    }
    for (std::size_t s = 0; s < model.pairwise.size(); ++s)
        add_classifier(file, fmt::format("pairwise.{}", s), model.pairwise[s]);
    file.add("smallest_component", {model.class_count()}, model.smallest_component);
    write_safetensors(path, file);
}

LabelingModel load_model(const std::filesystem::path& path) {
    const TensorFile file = read_safetensors(path);
    if (const auto kind = file.metadata.find("kind"); kind == file.metadata.end() || kind->second != k_kind)
        throw ModelError(fmt::format("{}: is no mesh labeling model; make one with 'exemplar label train'", file.path));
    require_version(file, "format_version", k_model_format_version, "train it again");
    require_version(file, "feature_version", k_feature_version, "its features have changed: train it again");
    LabelingModel model;
    try {
        read_model_description(file, model);
    } catch (const Json::exception& error) {
        inconsistent(file, "its description cannot be read");
    }
    check_model_description(file, model);

    const std::size_t classes = model.class_count();
    const std::size_t context = k_context_measures * k_context_bins * classes;
    model.linear.resize(model.unary.size());
    for (std::size_t s = 0; s < model.unary.size(); ++s) {
        const std::size_t features = model.unary_names.size() + (s ? context : 0);
        model.unary[s] = get_classifier(file, fmt::format("unary.{}", s), classes, features);
        model.linear[s] = find_linear(file, fmt::format("linear.{}", s), classes, features);
    }
    if (uses_orientation(model)) {
        const std::size_t features = model.unary_names.size() - orientation_names().size();
        model.unoriented = get_classifier(file, "unoriented", classes, features);
        model.unoriented_linear = find_linear(file, "unoriented.linear", classes, features);
    }
    for (std::size_t s = 0; s < model.pairwise.size(); ++s)
        model.pairwise[s] = get_classifier(file, fmt::format("pairwise.{}", s), 2,
                                           model.pairwise_names.size() + (s ? EdgeNeighborhood::k_bins : 0));
    model.smallest_component = file.get<float>("smallest_component", {classes});
    require_finite(file, "smallest_component", model.smallest_component);
    return model;
}

}  // namespace exemplar
