#include "host/imaging/vectors/svg_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/imaging/vectors/path_data.h"
#include "host/mesh/color_text.h"

namespace exemplar {
namespace {

/// Returns the first 40 bytes of a text in UTF-8, or a little less so that no character is cut: a message quotes them.
std::string beginning_of(std::string_view text) {
    constexpr std::size_t k_most_bytes = 40;
    std::size_t end = std::min(text.size(), k_most_bytes);
    const auto goes_on = [&](std::size_t at) { return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U; };
    while (end < text.size() && end > 0 && goes_on(end)) --end;
    return without_controls(text.substr(0, end));
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view k_space = " \t\r\n\f";
    const std::size_t first = text.find_first_not_of(k_space);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(k_space) - first + 1);
}

/// Takes the part before a separator from a text, and the separator.
std::string_view take_part(std::string_view& text, char separator) {
    const std::size_t end = std::min(text.find(separator), text.size());
    const std::string_view part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

/// Returns "#rgba" and "#rrggbbaa" without their last channel.
std::string_view without_alpha(std::string_view hex) {
    const std::size_t digits = hex.size() == 5 ? 1 : hex.size() == 9 ? 2 : 0;
    return hex.substr(0, hex.size() - digits);
}

std::optional<Color> rgb_color(std::string_view text) {
    const std::size_t open = text.find('('), close = text.find(')');
    if (!text.starts_with("rgb") || open == std::string_view::npos || close == std::string_view::npos || close < open)
        return std::nullopt;
    std::string list(text.substr(open + 1, close - open - 1));
    const double scale = list.find('%') == std::string::npos ? 1 : 2.55;
    std::ranges::replace(list, '%', ' ');
    std::ranges::replace(list, '/', ' ');
    const std::vector<double> values = svg_numbers(list);
    if (values.size() < 3) return std::nullopt;
    Color color{};
    for (std::size_t c = 0; c < 3; ++c)
        color[c] = static_cast<std::uint8_t>(std::lround(std::clamp(scale * values[c], 0.0, 255.0)));
    return color;
}

Color svg_color_of(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, Color>, 19> k_names{{{"black", {0, 0, 0}},
                                                                          {"white", {255, 255, 255}},
                                                                          {"gray", {128, 128, 128}},
                                                                          {"grey", {128, 128, 128}},
                                                                          {"silver", {192, 192, 192}},
                                                                          {"dimgray", {105, 105, 105}},
                                                                          {"darkgray", {169, 169, 169}},
                                                                          {"lightgray", {211, 211, 211}},
                                                                          {"red", {255, 0, 0}},
                                                                          {"maroon", {128, 0, 0}},
                                                                          {"yellow", {255, 255, 0}},
                                                                          {"olive", {128, 128, 0}},
                                                                          {"lime", {0, 255, 0}},
                                                                          {"green", {0, 128, 0}},
                                                                          {"aqua", {0, 255, 255}},
                                                                          {"teal", {0, 128, 128}},
                                                                          {"blue", {0, 0, 255}},
                                                                          {"navy", {0, 0, 128}},
                                                                          {"purple", {128, 0, 128}}}};
    for (const auto& [name, color] : k_names)
        if (text == name) return color;
    std::optional<Color> color = text.starts_with('#') ? color_of_hex(without_alpha(text)) : rgb_color(text);
    if (!color) throw UsageError(fmt::format("strokes of color '{}'", beginning_of(text)));
    return *color;
}

double svg_share(std::string_view text) {
    const bool percent = text.ends_with('%');
    if (percent) text.remove_suffix(1);
    const std::vector<double> values = svg_numbers(text);
    if (values.size() != 1) throw UsageError(fmt::format("an opacity of '{}'", beginning_of(text)));
    return std::clamp(values[0] / (percent ? 100 : 1), 0.0, 1.0);
}

Eigen::Affine2d transform_step(std::string_view name, const std::vector<double>& v) {
    using Eigen::Vector2d;
    Eigen::Affine2d step = Eigen::Affine2d::Identity();
    constexpr double k_degree = std::numbers::pi / 180;
    if (name == "matrix" && v.size() == 6) {
        step.linear() << v[0], v[2], v[1], v[3];
        step.translation() << v[4], v[5];
    } else if (name == "translate" && (v.size() == 1 || v.size() == 2)) {
        step.translate(Vector2d(v[0], v.size() > 1 ? v[1] : 0));
    } else if (name == "scale" && (v.size() == 1 || v.size() == 2)) {
        step.scale(Vector2d(v[0], v.back()));
    } else if (name == "rotate" && (v.size() == 1 || v.size() == 3)) {
        const Vector2d center = v.size() == 3 ? Vector2d(v[1], v[2]) : Vector2d::Zero();
        step.translate(center).rotate(v[0] * k_degree).translate(-center);
    } else if (name == "skewX" && v.size() == 1) {
        step.linear()(0, 1) = std::tan(v[0] * k_degree);
    } else if (name == "skewY" && v.size() == 1) {
        step.linear()(1, 0) = std::tan(v[0] * k_degree);
    } else {
        throw UsageError(fmt::format("a transform '{}' of {}", beginning_of(name), counted(v.size(), "number")));
    }
    return step;
}

Eigen::Affine2d svg_transform(std::string_view text) {
    Eigen::Affine2d all = Eigen::Affine2d::Identity();
    while (!(text = trimmed(text)).empty()) {
        if (text.starts_with(',')) {
            text.remove_prefix(1);
            continue;
        }
        const std::string_view name = trimmed(take_part(text, '('));
        all = all * transform_step(name, svg_numbers(take_part(text, ')')));
    }
    return all;
}

void declare_stroke(std::string_view value, SvgLook& look) {
    look.stroked = value != "none" && value != "transparent";
    if (!look.stroked) return;
    look.color = lower_case(value) == "currentcolor" ? look.current : svg_color_of(lower_case(value));
}

bool has_dashes(std::string_view value) {
    return value.find_first_of("123456789") != std::string_view::npos;
}

}  // namespace

double svg_length(std::string_view text) {
    text = trimmed(text);
    constexpr std::array<std::pair<std::string_view, double>, 6> k_units{
        {{"px", 1}, {"mm", 96 / 25.4}, {"cm", 96 / 2.54}, {"in", 96}, {"pt", 96.0 / 72}, {"pc", 16}}};
    double scale = 1;
    for (const auto& [unit, pixels] : k_units)
        if (text.ends_with(unit)) {
            scale = pixels;
            text.remove_suffix(unit.size());
            break;
        }
    const std::vector<double> values = svg_numbers(text);
    if (values.size() != 1) throw UsageError("a length that is not one number");
    return scale * values[0];
}

void add_svg_style(std::string_view style, SvgDeclarations& declarations) {
    while (!style.empty()) {
        std::string_view value = take_part(style, ';');
        const std::string_view name = trimmed(take_part(value, ':'));
        value = trimmed(value);
        if (value.ends_with("!important")) value = trimmed(value.substr(0, value.size() - 10));
        if (!name.empty() && !value.empty()) declarations[std::string(name)] = value;
    }
}

std::map<std::string, SvgDeclarations, std::less<>> svg_classes(std::string_view sheet) {
    std::map<std::string, SvgDeclarations, std::less<>> classes;
    while (!sheet.empty()) {
        std::string_view selectors = take_part(sheet, '{');
        const std::string_view style = take_part(sheet, '}');
        while (!selectors.empty()) {
            const std::string_view selector = trimmed(take_part(selectors, ','));
            if (selector.starts_with('.') && selector.find_first_of(" >:.#[", 1) == std::string_view::npos)
                add_svg_style(style, classes[std::string(selector.substr(1))]);
        }
    }
    return classes;
}

SvgLook svg_look_inside(const SvgLook& outer, const SvgDeclarations& declarations, std::string_view transform) {
    SvgLook look = outer;
    look.to_page = outer.to_page * svg_transform(transform);
    const auto with = [&](std::string_view name, auto&& use) {
        const auto at = declarations.find(name);
        if (at != declarations.end() && at->second != "inherit") use(std::string_view(at->second));
    };
    with("color", [&](std::string_view value) { look.current = svg_color_of(lower_case(value)); });
    with("stroke", [&](std::string_view value) { declare_stroke(value, look); });
    with("stroke-width", [&](std::string_view value) { look.width = std::max(0.0, svg_length(value)); });
    with("stroke-opacity", [&](std::string_view value) { look.stroke_opacity = svg_share(value); });
    with("opacity", [&](std::string_view value) { look.opacity *= svg_share(value); });
    with("stroke-dasharray", [&](std::string_view value) { look.dashed = has_dashes(value); });
    with("visibility", [&](std::string_view value) { look.visible = value == "visible"; });
    with("display", [&](std::string_view value) { look.shown = look.shown && value != "none"; });
    return look;
}

}  // namespace exemplar
