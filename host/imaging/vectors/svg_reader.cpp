#include "host/imaging/vectors/svg_reader.h"

#include <expat.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include "host/core/errors.h"
#include "host/core/text.h"
#include "host/imaging/vectors/path_data.h"
#include "host/imaging/vectors/svg_look.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;

constexpr std::size_t k_max_svg_points = std::size_t{1} << 24;
constexpr double k_flatness = 2e-5;  ///< of curves, in longer sides of the page
constexpr double k_max_place = 1e9;

/// The attributes of an element: pairs of names and values.
class SvgAttributes {
  public:
    explicit SvgAttributes(const XML_Char** attributes) {
        for (; *attributes; attributes += 2) all_.emplace_back(attributes[0], attributes[1]);
    }
    std::optional<std::string_view> find(std::string_view name) const {
        for (const auto& [each, value] : all_)
            if (each == name) return value;
        return std::nullopt;
    }
    std::string_view text(std::string_view name) const { return find(name).value_or(std::string_view()); }
    double length(std::string_view name, double otherwise = 0) const {
        const auto value = find(name);
        return value ? svg_length(*value) : otherwise;
    }
    const std::vector<std::pair<std::string_view, std::string_view>>& all() const { return all_; }

  private:
    std::vector<std::pair<std::string_view, std::string_view>> all_;
};

/// An element that is open.
struct OpenElement {
    SvgLook look;
    int group = -1;
};

bool is_undrawn(std::string_view element) {
    constexpr std::array<std::string_view, 8> k_undrawn{"defs",    "symbol", "clipPath", "mask",
                                                        "pattern", "marker", "font",     "foreignObject"};
    return std::ranges::find(k_undrawn, element) != k_undrawn.end();
}

std::string round_path(const Vector2d& center, const Vector2d& radii) {
    return fmt::format("M{},{}a{},{} 0 1 0 {},0a{},{} 0 1 0 {},0z", center.x() - radii.x(), center.y(), radii.x(),
                       radii.y(), 2 * radii.x(), radii.x(), radii.y(), -2 * radii.x());
}

/// Returns an element's lines as the data of a path; empty if it draws none.
std::string path_of(std::string_view element, const SvgAttributes& a) {
    if (element == "path") return std::string(a.text("d"));
    if (element == "line")
        return fmt::format("M{},{}L{},{}", a.length("x1"), a.length("y1"), a.length("x2"), a.length("y2"));
    if (element == "polyline" || element == "polygon") {
        const std::string_view points = a.text("points");
        if (svg_numbers(points).size() < 4) return {};
        return fmt::format("M{}{}", points, element == "polygon" ? "z" : "");
    }
    if (element == "rect")
        return fmt::format("M{},{}h{}v{}h{}z", a.length("x"), a.length("y"), a.length("width"), a.length("height"),
                           -a.length("width"));
    const Vector2d center(a.length("cx"), a.length("cy"));
    if (element == "circle") return round_path(center, Vector2d::Constant(a.length("r")));
    if (element == "ellipse") return round_path(center, {a.length("rx"), a.length("ry")});
    return {};
}

/// Collects the strokes of a document.
class SvgCollector {
  public:
    void open(std::string_view element, const XML_Char** attributes) {
        if (element.starts_with("svg:")) element.remove_prefix(4);
        if (undrawn_ > 0 || is_undrawn(element)) ++undrawn_;
        in_sheet_ = element == "style";
        if (undrawn_ > 0) return;
        const SvgAttributes a(attributes);
        OpenElement inside = elements_.empty() ? OpenElement() : elements_.back();
        if (element == "svg" && elements_.empty()) open_page(a, inside);
        if (elements_.empty() && element != "svg") throw UsageError("it does not begin with <svg>");
        inside.look = svg_look_inside(inside.look, declarations_of(a), a.text("transform"));
        if (element == "g") name_group(a, inside);
        elements_.push_back(inside);
        if (!inside.look.shown) return;
        if (element == "use") throw UsageError("copies (<use>); unlink clones");
        if (inside.look.visible && inside.look.stroked) add_strokes(path_of(element, a), inside);
    }
    void close() {
        if (in_sheet_) read_sheet();
        if (undrawn_ > 0)
            --undrawn_;
        else
            elements_.pop_back();
    }
    void text(std::string_view text) {
        if (in_sheet_) sheet_ += text;
    }
    SvgPicture take() { return std::move(picture_); }

  private:
    void read_sheet() {
        for (auto& [name, declarations] : svg_classes(sheet_))
            for (auto& [property, value] : declarations) classes_[name][property] = value;
        sheet_.clear();
        in_sheet_ = false;
    }

    /// Reads the size of the page, and moves its corner to the origin.
    void open_page(const SvgAttributes& a, OpenElement& page) {
        std::vector<double> box = svg_numbers(a.text("viewBox"));
        if (box.empty() && a.find("width") && a.find("height")) box = {0, 0, a.length("width"), a.length("height")};
        if (box.size() != 4 || !(box[2] > 0) || !(box[3] > 0))
            throw UsageError("no size of its page (viewBox, or width and height)");
        picture_.width = box[2];
        picture_.height = box[3];
        page.look.to_page.translate(Vector2d(-box[0], -box[1]));
    }

    SvgDeclarations declarations_of(const SvgAttributes& a) const {
        SvgDeclarations out;
        for (const auto& [name, value] : a.all()) out[std::string(name)] = value;
        std::string_view names = a.text("class");
        while (!names.empty()) {
            const std::size_t end = std::min(names.find(' '), names.size());
            const auto at = classes_.find(names.substr(0, end));
            names.remove_prefix(std::min(end + 1, names.size()));
            if (at == classes_.end()) continue;
            for (const auto& [name, value] : at->second) out[name] = value;
        }
        add_svg_style(a.text("style"), out);
        return out;
    }

    void name_group(const SvgAttributes& a, OpenElement& group) {
        const bool is_layer = a.text("inkscape:groupmode") == "layer" && a.find("inkscape:label");
        const std::string_view name = a.text(is_layer ? "inkscape:label" : "id");
        if (name.empty()) return;
        picture_.groups.push_back({std::string(name), group.group});
        group.group = static_cast<int>(picture_.groups.size()) - 1;
    }

    void add_strokes(const std::string& path, const OpenElement& element) {
        if (path.empty()) return;
        const SvgLook& look = element.look;
        const double scale = std::sqrt(std::abs(look.to_page.linear().determinant()));
        const double opacity = look.opacity * look.stroke_opacity, width = look.width * scale;
        if (!(width > 0) || !(opacity > 0)) return;
        if (look.dashed) throw UsageError("strokes with dashes; make them solid");
        if (!(width < k_max_place)) throw UsageError("a stroke that is too wide");
        const double tolerance = k_flatness * std::max(picture_.width, picture_.height) / scale;
        for (Polyline& line : flattened_path(path, std::max(tolerance, 1e-12))) {
            points_ += line.points.size();
            if (points_ > k_max_svg_points) throw UsageError("more than 2^24 points");
            for (Vector2d& point : line.points) {
                point = look.to_page * point;
                if (!(point.cwiseAbs().maxCoeff() < k_max_place)) throw UsageError("a point that is too far away");
            }
            picture_.strokes.push_back(
                {std::move(line.points), line.closed, width, look.color, opacity, element.group});
        }
    }

    SvgPicture picture_;
    std::vector<OpenElement> elements_;
    std::map<std::string, SvgDeclarations, std::less<>> classes_;
    std::string sheet_;
    bool in_sheet_ = false;
    std::size_t undrawn_ = 0;  ///< elements that are open inside of what is not drawn, with it
    std::size_t points_ = 0;
};

/// Parses a document. Errors must not pass through the library, which is in C: they wait until it returns.
class SvgParser {
  public:
    SvgParser(std::string_view content, const std::string& name) : parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
        XML_SetUserData(parser_.get(), this);
        XML_SetElementHandler(parser_.get(), begin_element, end_element);
        XML_SetCharacterDataHandler(parser_.get(), take_text);
        const auto result = XML_Parse(parser_.get(), content.data(), static_cast<int>(content.size()), 1);
        const auto line = XML_GetCurrentLineNumber(parser_.get());
        if (!error_.empty())
            throw DataError(fmt::format("{}: line {}: an SVG with {}: not read; export it as PNG", name, line, error_));
        if (other_error_) std::rethrow_exception(other_error_);
        if (result != XML_STATUS_OK)
            throw DataError(fmt::format("{}: line {}: not a readable SVG: {}; export it as PNG", name, line,
                                        XML_ErrorString(XML_GetErrorCode(parser_.get()))));
    }
    SvgPicture take() { return collector_.take(); }

  private:
    template <typename Action>
    void guarded(Action&& action) {
        if (failed_) return;
        try {
            action();
            return;
        } catch (const UsageError& error) {
            error_ = error.what();
        } catch (...) {
            other_error_ = std::current_exception();
        }
        failed_ = true;
        XML_StopParser(parser_.get(), XML_FALSE);
    }
    static void begin_element(void* self, const XML_Char* name, const XML_Char** attributes) {
        auto* parser = static_cast<SvgParser*>(self);
        parser->guarded([&] { parser->collector_.open(name, attributes); });
    }
    static void end_element(void* self, const XML_Char*) {
        auto* parser = static_cast<SvgParser*>(self);
        parser->guarded([&] { parser->collector_.close(); });
    }
    static void take_text(void* self, const XML_Char* text, int size) {
        auto* parser = static_cast<SvgParser*>(self);
        parser->guarded([&] { parser->collector_.text({text, static_cast<std::size_t>(size)}); });
    }

    std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> parser_;
    SvgCollector collector_;
    std::string error_;
    std::exception_ptr other_error_;
    bool failed_ = false;
};

}  // namespace

bool is_svg(std::string_view content) {
    const std::string_view start = content.substr(0, 4096);
    const std::size_t first = start.find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first != std::string_view::npos && start[first] == '<' && start.find("<svg") != std::string_view::npos;
}

SvgPicture read_svg(std::string_view content, const std::string& name) {
    constexpr std::size_t k_max_bytes = std::size_t{1} << 30;
    if (content.size() > k_max_bytes) throw DataError(fmt::format("{}: an SVG of more than 2^30 bytes", name));
    SvgPicture picture = SvgParser(content, name).take();
    if (picture.strokes.empty())
        throw DataError(fmt::format("{}: an SVG without strokes; filled shapes are not read: export it as PNG", name));
    return picture;
}

}  // namespace exemplar
