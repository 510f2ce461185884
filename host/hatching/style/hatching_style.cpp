#include "host/hatching/style/hatching_style.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "host/core/errors.h"
#include "host/core/json_text.h"
#include "host/data/model_file.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/style/pixel_classifier.h"

namespace exemplar {
namespace {

using Json = nlohmann::json;

constexpr const char* k_kind = "exemplar hatching style";
constexpr int k_format_version = 2;
constexpr std::size_t k_max_segments = 64;
constexpr int k_max_stages = 16, k_max_drawing = 1 << 15;
constexpr float k_max_pen = 1000, k_max_object = 1e6f;  ///< pixels

void add_function(TensorFile& file, const std::string& name, const OrientationFunction& function) {
    std::vector<std::uint32_t> features;
    std::vector<float> weights;
    for (const auto& term : function.terms) {
        features.push_back(term.feature);
        weights.push_back(term.weight);
    }
    file.add(name + ".feature", {features.size()}, features);
    file.add(name + ".weight", {weights.size()}, weights);
}

OrientationFunction get_function(const TensorFile& file, const std::string& name) {
    const auto features = file.get<std::uint32_t>(name + ".feature", {TensorFile::k_any});
    const auto weights = file.get<float>(name + ".weight", {features.size()});
    require_finite(file, name + ".weight", weights);
    OrientationFunction function;
    for (std::size_t k = 0; k < features.size(); ++k) {
        if (features[k] >= k_orientation_features)
            inconsistent(
                file, fmt::format("{} uses orientation feature {} of {}", name, features[k], k_orientation_features));
        function.terms.push_back({features[k], weights[k]});
    }
    return function;
}

void add_property(TensorFile& file, const std::string& name, const PropertyModel& model) {
    std::vector<std::uint32_t> features;
    std::vector<float> values;
    for (const PropertyModel::Term& term : model.terms) {
        features.push_back(term.feature);
        values.insert(values.end(), {term.a, term.b, term.exponent, term.low, term.high, term.least});
    }
    file.add(name + ".feature", {features.size()}, features);
    file.add(name + ".a_b_exponent_low_high_least", {features.size(), 6}, values);
    file.add(name + ".factor", {1}, std::vector<float>{model.factor});
}

void add_correction(TensorFile& file, const std::string& name, const DirectionCorrection& correction) {
    std::vector<std::uint32_t> features_parts;
    std::vector<float> values;
    for (const DirectionStump& stump : correction.stumps) {
        features_parts.insert(features_parts.end(), {stump.feature, stump.part});
        values.insert(values.end(), {stump.threshold, stump.below, stump.above});
    }
    file.add(name + ".rule_weight", {correction.rule_weight.size()}, correction.rule_weight);
    file.add(name + ".feature_part", {correction.stumps.size(), 2}, features_parts);
    file.add(name + ".threshold_below_above", {correction.stumps.size(), 3}, values);
}

DirectionCorrection get_correction(const TensorFile& file, const std::string& name, std::size_t segments,
                                   std::size_t features) {
    DirectionCorrection correction;
    correction.rule_weight = file.get<float>(name + ".rule_weight", {TensorFile::k_any});
    require_finite(file, name + ".rule_weight", correction.rule_weight);
    if (!correction.empty() && correction.rule_weight.size() != segments)
        inconsistent(file, fmt::format("{} is of {} segments of {}", name, correction.rule_weight.size(), segments));
    const auto numbers = file.get<std::uint32_t>(name + ".feature_part", {TensorFile::k_any, 2});
    const auto values = file.get<float>(name + ".threshold_below_above", {numbers.size() / 2, 3});
    require_finite(file, name + ".threshold_below_above", values);
    if (correction.empty() && !numbers.empty()) inconsistent(file, name + " has stumps, but no weights of rules");
    for (std::size_t k = 0; k < numbers.size() / 2; ++k) {
        const DirectionStump stump{numbers[2 * k], values[3 * k], numbers[2 * k + 1], values[3 * k + 1],
                                   values[3 * k + 2]};
        if (stump.feature >= features)
            inconsistent(file, fmt::format("{} uses feature {} of {}", name, stump.feature, features));
        if (stump.part >= k_direction_parts)
            inconsistent(file, fmt::format("{} uses direction {} of {}", name, stump.part, k_direction_parts));
        correction.stumps.push_back(stump);
    }
    return correction;
}

void add_familiarity(TensorFile& file, const Familiarity& familiarity) {
    const std::size_t features = familiarity.offset.size();
    file.add("familiarity.offset", {features}, familiarity.offset);
    file.add("familiarity.scale", {features}, familiarity.scale);
    file.add("familiarity.samples", {features > 0 ? familiarity.samples.size() / features : 0, features},
             familiarity.samples);
    file.add("familiarity.reach", {1}, std::vector<float>{familiarity.reach});
}

Familiarity get_familiarity(const TensorFile& file) {
    Familiarity out;
    out.offset = file.get<float>("familiarity.offset", {TensorFile::k_any});
    const std::size_t features = out.offset.size();
    if (features != 0 && features != familiar_features().size())
        inconsistent(file,
                     fmt::format("familiarity is judged by {} features of {}", features, familiar_features().size()));
    out.scale = file.get<float>("familiarity.scale", {features});
    out.samples = file.get<float>("familiarity.samples", {TensorFile::k_any, features});
    out.reach = file.get<float>("familiarity.reach", {1})[0];
    require_finite(file, "familiarity.offset", out.offset);
    require_finite(file, "familiarity.scale", out.scale);
    require_finite(file, "familiarity.samples", out.samples);
    if (!(out.reach > 0) || !std::isfinite(out.reach)) inconsistent(file, "familiarity.reach is not positive");
    return out;
}

PropertyModel get_property(const TensorFile& file, const std::string& name, std::size_t feature_count) {
    const auto features = file.get<std::uint32_t>(name + ".feature", {TensorFile::k_any});
    const auto values = file.get<float>(name + ".a_b_exponent_low_high_least", {features.size(), 6});
    require_finite(file, name, values);
    PropertyModel model;
    model.factor = file.get<float>(name + ".factor", {1})[0];
    if (!(model.factor > 0) || !std::isfinite(model.factor)) inconsistent(file, name + ".factor is not positive");
    for (std::size_t k = 0; k < features.size(); ++k) {
        const float* v = values.data() + 6 * k;
        if (features[k] >= k_powers * feature_count)
            inconsistent(file, fmt::format("{} uses feature {} of {}", name, features[k], k_powers * feature_count));
        if (!(v[5] > 0)) inconsistent(file, name + " has a term without a least value");
        if (!(v[3] <= v[4])) inconsistent(file, name + " has a term without a range");
        model.terms.push_back({features[k], v[0], v[1], v[2], v[3], v[4], v[5]});
    }
    return model;
}

Json described(const PixelCrfParameters& cut) {
    return {{"strength", cut.strength}, {"offset", cut.offset}};
}

PixelCrfParameters read_cut(const TensorFile& file, const Json& json) {
    const PixelCrfParameters cut{json.at("strength"), json.at("offset")};
    if (!(cut.strength >= 0) || !std::isfinite(cut.strength) || !std::isfinite(cut.offset))
        inconsistent(file, "a weight of its label cuts is out of range");
    return cut;
}

/// Reads a count in 1 to `most`, as a double, since a JSON number need not be an integer.
int read_count(const TensorFile& file, const Json& json, const char* key, int most) {
    const double count = json.at(key);
    if (!(count >= 1 && count <= most) || count != std::floor(count))
        inconsistent(file, fmt::format("'{}' is {}, which is not a whole number from 1 to {}", key, count, most));
    return static_cast<int>(count);
}

/// Reads a length in pixels; `otherwise` where it is missing.
float read_pixels(const TensorFile& file, const Json& json, const char* key, float otherwise, float most) {
    const float pixels = json.value(key, otherwise);
    if (!(pixels >= 0 && pixels <= most))
        inconsistent(file, fmt::format("'{}' is {}, not from 0 to {}", key, pixels, most));
    return pixels;
}

void read_description(const TensorFile& file, HatchingStyle& style, std::size_t& stages) {
    const Json json = parse_json(file.meta("style"));
    style.name = json.at("name");
    style.width = read_count(file, json, "width", k_max_drawing);
    style.height = read_count(file, json, "height", k_max_drawing);
    style.object_size = read_pixels(file, json, "object_size", 0, k_max_object);
    style.taper = read_pixels(file, json, "taper", k_usual_taper, k_max_pen);
    style.outline_width = read_pixels(file, json, "outline_width", 0, k_max_pen);
    style.parts = json.value("parts", std::vector<std::string>());
    if (style.parts.size() > k_max_classes)
        inconsistent(file, fmt::format("it has {} parts; {} are possible", style.parts.size(), k_max_classes));
    style.share = json.at("share").get<std::vector<double>>();
    style.segment_crf = read_cut(file, json.at("segment_cut"));
    style.level_crf = read_cut(file, json.at("level_cut"));
    stages = static_cast<std::size_t>(read_count(file, json, "stages", k_max_stages));
    if (style.share.empty() || style.share.size() > k_max_segments)
        inconsistent(file, fmt::format("it has {} segments", style.share.size()));
}

bool is_style(const TensorFile& file) {
    const auto kind = file.metadata.find("kind");
    return kind != file.metadata.end() && kind->second == k_kind;
}

}  // namespace

std::size_t HatchingStyle::scalar_count() const {
    return k_pixel_features + parts.size();
}

std::size_t HatchingStyle::feature_count() const {
    return scalar_count() + contextual_feature_count(rules.size());
}

void HatchingStyle::resize(int new_width, int new_height) {
    const float factor =
        static_cast<float>(std::min(new_width, new_height)) / static_cast<float>(std::min(width, height));
    width = new_width;
    height = new_height;
    taper *= factor;
    outline_width *= factor;
    for (const StrokeProperty length : {StrokeProperty::thickness, StrokeProperty::spacing, StrokeProperty::length})
        properties[static_cast<std::size_t>(length)].factor *= factor;
}

void save_hatching_style(const std::filesystem::path& path, const HatchingStyle& style) {
    TensorFile file;
    file.metadata["kind"] = k_kind;
    file.metadata["format_version"] = std::to_string(k_format_version);
    file.metadata["feature_version"] = std::to_string(k_hatching_feature_version);
    const Json description{{"name", style.name},
                           {"width", style.width},
                           {"height", style.height},
                           {"object_size", style.object_size},
                           {"taper", style.taper},
                           {"outline_width", style.outline_width},
                           {"parts", style.parts},
                           {"share", style.share},
                           {"segment_cut", described(style.segment_crf)},
                           {"level_cut", described(style.level_crf)},
                           {"stages", style.segments.size()}};
    // A file name need not be valid UTF-8.
    file.metadata["style"] = json_text(description);
    for (std::size_t c = 0; c < style.rules.size(); ++c) {
        for (std::size_t j = 0; j < k_hatch_layers; ++j)
            add_function(file, fmt::format("rule.{}.{}", c, j), style.rules[c].function[j]);
    }
    for (std::size_t j = 0; j < k_hatch_layers; ++j)
        add_correction(file, fmt::format("direction.{}", j), style.corrections[j]);
    for (std::size_t s = 0; s < style.segments.size(); ++s)
        add_classifier(file, fmt::format("segments.{}", s), style.segments[s]);
    add_classifier(file, "boundary", style.boundary);
    add_classifier(file, "levels", style.levels);
    add_classifier(file, "rough_levels", style.rough_levels);
    add_familiarity(file, style.familiarity);
    for (std::size_t p = 0; p < k_stroke_properties; ++p)
        add_property(file, name_of(static_cast<StrokeProperty>(p)), style.properties[p]);
    write_safetensors(path, file);
}

bool is_hatching_style(const std::filesystem::path& path) {
    return is_style(read_safetensors(path));
}

HatchingStyle load_hatching_style(const std::filesystem::path& path) {
    const TensorFile file = read_safetensors(path);
    if (!is_style(file))
        throw ModelError(fmt::format("{}: is no hatching style; make one with 'exemplar hatch train'", file.path));
    require_version(file, "format_version", k_format_version, "train it again");
    require_version(file, "feature_version", k_hatching_feature_version, "its features have changed: train it again");
    HatchingStyle style;
    std::size_t stages = 0;
    try {
        read_description(file, style, stages);
    } catch (const Json::exception&) {
        inconsistent(file, "its description cannot be read");
    }
    const std::size_t labels = style.share.size();
    style.rules.resize(labels);
    for (std::size_t c = 0; c < labels; ++c) {
        for (std::size_t j = 0; j < k_hatch_layers; ++j)
            style.rules[c].function[j] = get_function(file, fmt::format("rule.{}.{}", c, j));
    }
    for (std::size_t j = 0; j < k_hatch_layers; ++j)
        style.corrections[j] = get_correction(file, fmt::format("direction.{}", j), labels, style.scalar_count());
    const std::size_t features = k_powers * style.feature_count();
    for (std::size_t s = 0; s < stages; ++s)
        style.segments.push_back(get_classifier(file, fmt::format("segments.{}", s), labels,
                                                s == 0 ? k_powers * style.scalar_count() : features));
    style.boundary = get_classifier(file, "boundary", 2, k_powers * k_pixel_features);
    style.levels = get_classifier(file, "levels", 3, features);
    style.rough_levels = get_classifier(file, "rough_levels", 3, features);
    style.familiarity = get_familiarity(file);
    for (std::size_t p = 0; p < k_stroke_properties; ++p)
        style.properties[p] = get_property(file, name_of(static_cast<StrokeProperty>(p)), style.feature_count());
    return style;
}

}  // namespace exemplar
