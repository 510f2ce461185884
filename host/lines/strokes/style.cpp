#include "host/lines/strokes/style.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <vector>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/json_text.h"
#include "host/core/text.h"
#include "host/lines/strokes/stroke_textures.h"
#include "host/mesh/color_text.h"

namespace exemplar {

namespace {

using Json = nlohmann::json;

struct NamedColor {
    const char* name;
    Color color;
};
constexpr std::array k_colors = {
    NamedColor{"black", {0, 0, 0}},      NamedColor{"white", {255, 255, 255}}, NamedColor{"gray", {128, 128, 128}},
    NamedColor{"red", {255, 0, 0}},      NamedColor{"green", {0, 128, 0}},     NamedColor{"blue", {0, 0, 255}},
    NamedColor{"yellow", {255, 255, 0}}, NamedColor{"orange", {255, 165, 0}},  NamedColor{"brown", {165, 42, 42}},
    NamedColor{"purple", {128, 0, 128}}, NamedColor{"navy", {0, 0, 128}},      NamedColor{"sepia", {112, 66, 20}}};

std::optional<Color> color_named(std::string_view text) {
    for (const NamedColor& known : k_colors)
        if (text == known.name) return known.color;
    return color_of_hex(text);
}

/// Returns text from a file as messages may show it: printable ASCII of limited length.
std::string shown(std::string_view text) {
    constexpr std::size_t k_longest = 60;
    std::string result(text.substr(0, k_longest));
    for (char& c : result)
        if (c < ' ' || c > '~') c = '?';
    return text.size() > k_longest ? result + "..." : result;
}

std::vector<std::string> words(std::initializer_list<const char*> list) {
    return {list.begin(), list.end()};
}

/// Reads the parts of a style, with their JSON pointers for messages.
class StyleReader {
  public:
    StyleReader(const std::string& name, const std::filesystem::path& folder) : name_(name), folder_(folder) {}

    DrawingStyle read(std::string_view text) const {
        const Json json = parse(text);
        DrawingStyle style;
        style.name = name_;
        std::vector<std::string> known = words({"about", "background", "surface", "fade", "default"});
        for (const LineType type : k_line_types) known.emplace_back(name_of(type));
        require_keys(json, "", known);
        if (json.contains("about")) string_of(json["about"], "/about");
        if (json.contains("background") && json["background"] != "none")
            style.background = color_of(json["background"], "/background", " or 'none'");
        if (json.contains("surface")) read_surface(json["surface"], style);
        if (json.contains("fade")) style.fade = number(json["fade"], "/fade", 0, 1e6);
        for (const LineType type : k_line_types) {
            LineStyle& line = style.of(type);
            if (json.contains("default")) read_line(json["default"], "/default", std::nullopt, line);
            const std::string key(name_of(type));
            if (json.contains(key)) read_line(json[key], "/" + key, type, line);
            require_widths(line, json.contains(key) ? "/" + key : "/default");
        }
        return style;
    }

  private:
    [[noreturn]] void fail(const std::string& pointer, const std::string& what) const {
        throw DataError(fmt::format("{}: {}: {}", name_, pointer.empty() ? "/" : pointer, what));
    }

    Json parse(std::string_view text) const {
        // The keys so far of each open object: the parser would silently replace the value of a repeated key.
        std::vector<std::set<std::string>> keys;
        std::string repeated;
        const auto watch = [&](int, Json::parse_event_t event, Json& value) {
            if (event == Json::parse_event_t::object_start) keys.emplace_back();
            if (event == Json::parse_event_t::object_end) keys.pop_back();
            if (event == Json::parse_event_t::key && !keys.back().insert(value.get<std::string>()).second &&
                repeated.empty())
                repeated = value.get<std::string>();
            return true;
        };
        Json json;
        try {
            json = parse_json(text, watch, true, true);
        } catch (const Json::exception& error) {
            throw DataError(not_json(text, error));
        }
        if (!repeated.empty()) fail("", fmt::format("has '{}' twice; keep one", shown(repeated)));
        return json;
    }
    std::string not_json(std::string_view text, const Json::exception& error) const {
        const auto* parse = dynamic_cast<const Json::parse_error*>(&error);
        const std::size_t at = parse && parse->byte > 0 ? std::min(parse->byte - 1, text.size()) : 0;
        const std::string_view before = text.substr(0, at);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        const std::size_t column = at - (before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1) + 1;
        std::string_view why = error.what();
        if (const std::size_t dash = why.find("- "); dash != std::string_view::npos) why.remove_prefix(dash + 2);
        if (const std::size_t last = why.find("; last read"); last != std::string_view::npos) why = why.substr(0, last);
        return fmt::format("{}:{}:{}: is no JSON ({}); 'exemplar lines --print-style ink' prints a style to start from",
                           name_, line, column, shown(why));
    }
    void require_keys(const Json& json, const std::string& pointer, const std::vector<std::string>& known) const {
        if (!json.is_object()) fail(pointer, fmt::format("is {}; give an object, {{...}}", json.type_name()));
        for (const auto& [key, value] : json.items())
            if (std::find(known.begin(), known.end(), key) == known.end())
                fail(pointer, fmt::format("has no key '{}'{}; the keys are {}", shown(key), suggestion(key, known),
                                          fmt::join(known, ", ")));
    }
    const std::string& string_of(const Json& json, const std::string& pointer) const {
        if (!json.is_string()) fail(pointer, fmt::format("is {}; give a word in quotes", json.type_name()));
        return json.get_ref<const std::string&>();
    }
    float number(const Json& json, const std::string& pointer, double least, double most) const {
        if (!json.is_number())
            fail(pointer, fmt::format("is {}; give a number from {} to {}", json.type_name(), least, most));
        const double value = json.get<double>();
        if (!(value >= least && value <= most))
            fail(pointer, fmt::format("{} is out of range; give a number from {} to {}", value, least, most));
        return static_cast<float>(value);
    }
    Color color_of(const Json& json, const std::string& pointer, const char* or_what = "") const {
        const std::string& text = string_of(json, pointer);
        if (const auto color = color_named(text)) return *color;
        std::vector<std::string> names(k_colors.size());
        std::transform(k_colors.begin(), k_colors.end(), names.begin(), [](const NamedColor& c) { return c.name; });
        fail(pointer, fmt::format("'{}' is no color{}; give '#rrggbb', '#rgb'{} or one of {}", shown(text),
                                  suggestion(text, names), or_what, fmt::join(names, ", ")));
    }
    void read_surface(const Json& json, DrawingStyle& style) const {
        require_keys(json, "/surface", words({"shading", "color"}));
        if (json.contains("color")) style.surface = color_of(json["color"], "/surface/color");
        if (!json.contains("shading")) return;
        const std::string& shading = string_of(json["shading"], "/surface/shading");
        const std::vector<std::string> known = words({"none", "paper", "shaded", "toon"});
        const auto at = std::find(known.begin(), known.end(), shading);
        if (at == known.end())
            fail("/surface/shading", fmt::format("'{}' is no shading{}; give one of {}", shown(shading),
                                                 suggestion(shading, known), fmt::join(known, ", ")));
        style.shading = static_cast<SurfaceShading>(at - known.begin());
    }
    /// `type`: none for the defaults of all types.
    void read_line(const Json& json, const std::string& pointer, std::optional<LineType> type, LineStyle& line) const {
        std::vector<std::string> known =
            words({"color", "opacity", "width", "epsilon", "least", "most", "taper", "texture"});
        if (type && has_threshold(*type)) known.emplace_back("threshold");
        require_keys(json, pointer, known);
        const auto set = [&](const char* key, float& value, double least, double most) {
            if (json.contains(key)) value = number(json[key], pointer + "/" + key, least, most);
        };
        if (json.contains("color")) line.color = color_of(json["color"], pointer + "/color");
        set("opacity", line.opacity, 0, 1);
        set("width", line.thickness.width, 0.001, 1000);
        set("epsilon", line.thickness.epsilon, 0.0001, 10000);
        set("least", line.thickness.least, 0, 1000);
        set("most", line.thickness.most, 0.001, 1000);
        set("taper", line.thickness.taper, 0, 10000);
        if (json.contains("texture")) line.texture = texture_of(json["texture"], pointer + "/texture");
        if (!json.contains("threshold")) return;
        float threshold = 0;
        set("threshold", threshold, 0, *type == LineType::creases ? 180 : 1e6);
        line.threshold = threshold;
    }
    std::string texture_of(const Json& json, const std::string& pointer) const {
        const std::string& text = string_of(json, pointer);
        std::vector<std::string> known = words({"none"});
        for (const std::string_view name : stroke_texture_names()) known.emplace_back(name);
        if (std::find(known.begin(), known.end(), text) != known.end()) return text;
        if (!std::filesystem::path(text).has_extension())
            fail(pointer, fmt::format("'{}' is no texture{}; give one of {}, or the path of a PNG file", shown(text),
                                      suggestion(text, known), fmt::join(known, ", ")));
        const std::filesystem::path path = folder_ / text;
        std::error_code ignored;
        if (!std::filesystem::is_regular_file(path, ignored))
            fail(pointer, fmt::format("there is no file '{}'{}", shown(path.string()), suggest_file(path)));
        return path.string();
    }
    void require_widths(const LineStyle& line, const std::string& pointer) const {
        if (line.thickness.least > line.thickness.most)
            fail(pointer, fmt::format("'least' is {}, above 'most', {}; swap them or set both", line.thickness.least,
                                      line.thickness.most));
    }

    const std::string& name_;
    const std::filesystem::path& folder_;
};

}  // namespace

LineThresholds DrawingStyle::thresholds(LineType type) const {
    LineThresholds thresholds;
    thresholds.fade = fade;
    if (of(type).threshold) set_threshold(thresholds, type, *of(type).threshold);
    return thresholds;
}

bool has_threshold(LineType type) {
    return type != LineType::contours && type != LineType::boundaries;
}

void set_threshold(LineThresholds& thresholds, LineType type, float value) {
    const float most = type == LineType::creases ? 180 : std::numeric_limits<float>::max();
    if (!(value >= 0 && value <= most))
        throw UsageError(fmt::format("a threshold of {} for {}: give a number that is not negative{}", value,
                                     name_of(type), type == LineType::creases ? ", at most 180 degrees" : ""));
    switch (type) {
        case LineType::suggestive_contours:
            thresholds.suggestive_contours = value;
            return;
        case LineType::suggestive_highlights:
            thresholds.suggestive_highlights = value;
            return;
        case LineType::principal_highlights:
            thresholds.principal_highlights = value;
            return;
        case LineType::ridges:
        case LineType::valleys:
            thresholds.ridges_valleys = value;
            return;
        case LineType::apparent_ridges:
            thresholds.apparent_ridges = value;
            return;
        case LineType::creases:
            thresholds.crease_angle = value * std::numbers::pi_v<float> / 180;
            return;
        case LineType::contours:
        case LineType::boundaries:
            throw UsageError(fmt::format("{} have no threshold: all of them are drawn", name_of(type)));
    }
}

DrawingStyle parse_style(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
    return StyleReader(name, folder).read(text);
}

DrawingStyle load_style(const std::string& name_or_path) {
    const auto names = builtin_style_names();
    if (std::find(names.begin(), names.end(), name_or_path) != names.end())
        return parse_style(builtin_style_text(name_or_path), name_or_path, {});
    const std::filesystem::path path = name_or_path;
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        const std::vector<std::string> known(names.begin(), names.end());
        std::string mend = suggestion(name_or_path, known);
        if (mend.empty()) mend = suggest_file(path);
        throw DataError(fmt::format("{}: is neither a style file nor a style{}; the styles are {}", name_or_path, mend,
                                    fmt::join(names, ", ")));
    }
    return parse_style(read_file(path), name_or_path, path.parent_path());
}

}  // namespace exemplar
