#include "host/parts/materials/material_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"
#include "host/mesh/color_text.h"

namespace exemplar {
namespace {

const std::vector<std::string> k_material_keys{"color", "metallic", "roughness", "texture", "size", "line", "hatching"};
const std::vector<std::string> k_ink_keys{"color", "width"};

[[noreturn]] void fail_material(const std::string& where, const std::string& expected) {
    throw DataError(where + ": " + expected);
}

Color material_color(const std::string& text, const std::string& where) {
    const std::optional<Color> color = color_of_hex(text);
    if (!color) fail_material(where, "a color is written \"#RRGGBB\", as \"#aa7744\"");
    return *color;
}

float number_between(const nlohmann::json& json, double low, double high, const std::string& where) {
    if (!json.is_number() || json.get<double>() < low || json.get<double>() > high)
        fail_material(where, fmt::format("expected a number from {} to {}", low, high));
    return json.get<float>();
}

[[noreturn]] void fail_key(const std::string& place, const std::string& key, const std::vector<std::string>& known) {
    fail_material(without_controls(place), "no such entry" + suggestion(key.substr(0, 255), known));
}

PartInk ink_of_json(const nlohmann::json& json, const std::string& where) {
    if (!json.is_object()) fail_material(where, "expected an object, as {\"color\": \"#aa7744\", \"width\": 1.5}");
    PartInk ink;
    for (const auto& [key, value] : json.items()) {
        const std::string place = where + ": " + key.substr(0, 40);
        if (key == "color") {
            if (!value.is_string()) fail_material(place, "expected text");
            ink.color = material_color(value.get<std::string>(), place);
        } else if (key == "width") {
            ink.width = number_between(value, 0, 100, place);
        } else {
            fail_key(place, key, k_ink_keys);
        }
    }
    return ink;
}

PartMaterial material_of_json(const nlohmann::json& json, const std::string& where,
                              const std::filesystem::path& folder) {
    if (!json.is_object()) fail_material(where, "expected an object, as {\"color\": \"#aa7744\", \"roughness\": 0.8}");
    PartMaterial material;
    for (const auto& [key, value] : json.items()) {
        const std::string place = where + ": " + key.substr(0, 40);
        if ((key == "color" || key == "texture") && !value.is_string()) fail_material(place, "expected text");
        if (key == "color") {
            material.color = material_color(value.get<std::string>(), place);
        } else if (key == "texture") {
            material.texture = folder / value.get<std::string>();
        } else if (key == "metallic") {
            material.metallic = number_between(value, 0, 1, place);
        } else if (key == "roughness") {
            material.roughness = number_between(value, 0, 1, place);
        } else if (key == "size") {
            material.size = number_between(value, 0.001, 1000, place);
        } else if (key == "line") {
            material.line = ink_of_json(value, place);
        } else if (key == "hatching") {
            material.hatching = ink_of_json(value, place);
        } else {
            fail_key(place, key, k_material_keys);
        }
    }
    return material;
}

}  // namespace

MaterialTable read_materials(const std::filesystem::path& path) {
    const nlohmann::json json = parse_json(read_file(path), nullptr, false);
    if (!json.is_object() || json.empty())
        fail_material(path.string(), "expected materials by label, as {\"torso\": {\"color\": \"#aa7744\"}}");
    MaterialTable table;
    for (const auto& [label, value] : json.items())
        table[label] = material_of_json(
            value, fmt::format("{}: '{}'", path.string(), without_controls(label.substr(0, 40))), path.parent_path());
    return table;
}

}  // namespace exemplar
