#include "host/imaging/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <ostream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"

namespace exemplar {

namespace {

constexpr std::string_view k_replacement = "\xEF\xBF\xBD";  // U+FFFD

void append_number(double value, int decimals, std::string& text) {
    if (!std::isfinite(value)) throw UsageError("an SVG file cannot hold a number that is not finite");
    std::array<char, 400> digits{};  // the largest double has 309 before the point
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                            std::chars_format::fixed, std::clamp(decimals, 0, 6));
    std::string_view number(digits.data(), static_cast<std::size_t>(end - digits.data()));
    if (number.find('.') != std::string_view::npos) {
        number = number.substr(0, number.find_last_not_of('0') + 1);
        if (number.back() == '.') number.remove_suffix(1);
    }
    text += number == "-0" ? std::string_view("0") : number;
}

}  // namespace

std::string svg_number(double value, int decimals) {
    std::string text;
    append_number(value, decimals, text);
    return text;
}

std::string svg_escaped(std::string_view text) {
    const bool utf8 = is_utf8(text);
    std::string result;
    for (const char c : text) {
        if (c == '&') {
            result += "&amp;";
        } else if (c == '<') {
            result += "&lt;";
        } else if (c == '>') {
            result += "&gt;";
        } else if (c == '"') {
            result += "&quot;";
        } else if ((static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\n') || c == 0x7f ||
                   (!utf8 && static_cast<unsigned char>(c) >= 0x80)) {
            result += k_replacement;
        } else {
            result += c;
        }
    }
    return result;
}

void SvgPath::add(const Vec2& point) {
    const Vec2 inside = point.cwiseMax(0).cwiseMin(most_);
    append_number(static_cast<double>(inside.x()), 2, data_);
    data_ += ' ';
    append_number(static_cast<double>(inside.y()), 2, data_);
}

void SvgPath::add(char command, const Vec2& point) {
    data_ += command;
    add(point);
}

void SvgPath::curve_to(const Vec2& first, const Vec2& second, const Vec2& point) {
    add('C', first);
    add(' ', second);
    add(' ', point);
}

SvgDocument::SvgDocument(int width, int height, std::string_view title)
    : width_(width), height_(height), title_(svg_escaped(title)) {
    if (width <= 0 || height <= 0)
        throw UsageError(fmt::format("an SVG file of {} x {} pixels: give positive sizes", width, height));
}

void SvgDocument::open(std::string_view element, std::span<const SvgAttribute> attributes, bool empty) {
    body_.append(2 * depth_ + 2, ' ');
    body_ += '<';
    body_ += element;
    for (const auto& [name, value] : attributes) {
        body_ += ' ';
        body_ += name;
        body_ += "=\"";
        body_ += svg_escaped(value);
        body_ += '"';
    }
    body_ += empty ? "/>\n" : ">\n";
    if (!empty) ++depth_;
}

void SvgDocument::open_layer(std::string_view label, std::span<const SvgAttribute> attributes) {
    std::vector<SvgAttribute> all = {{"id", fmt::format("layer{}", ++layers_)},
                                     {"inkscape:groupmode", "layer"},
                                     {"inkscape:label", std::string(label)}};
    all.insert(all.end(), attributes.begin(), attributes.end());
    open("g", all, false);
}

void SvgDocument::close() {
    if (depth_ == 0) throw UsageError("no group of the SVG document is open; close() comes once after each");
    --depth_;
    body_.append(2 * depth_ + 2, ' ');
    body_ += "</g>\n";
}

void SvgDocument::add(std::string_view element, std::span<const SvgAttribute> attributes) {
    open(element, attributes, true);
}

void SvgDocument::add_text(std::string_view text, std::span<const SvgAttribute> attributes) {
    open("text", attributes, false);
    --depth_;
    body_.pop_back();  // the end of the line would be shown as a space
    body_ += svg_escaped(text) + "</text>\n";
}

std::string SvgDocument::text() const {
    if (depth_ != 0)
        throw UsageError(fmt::format("{} of the SVG document not closed", counted(depth_, "group is", "groups are")));
    return fmt::format(
               "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
               "<svg xmlns=\"http://www.w3.org/2000/svg\" "
               "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" "
               "width=\"{0}px\" height=\"{1}px\" viewBox=\"0 0 {0} {1}\">\n  <title>{2}</title>\n",
               width_, height_, title_) +
           body_ + "</svg>\n";
}

void write_svg(const std::filesystem::path& path, const SvgDocument& document) {
    const std::string text = document.text();
    write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

}  // namespace exemplar
