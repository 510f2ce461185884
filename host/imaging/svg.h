#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Formats a number for SVG: a point as the decimal separator, at most `decimals` decimals (0 to 6) but no trailing
/// zeros, never an exponent. Throws UsageError if it is not finite.
std::string svg_number(double value, int decimals = 2);
/// Escapes text for an attribute or for between tags; replaces what XML cannot hold by U+FFFD.
std::string svg_escaped(std::string_view text);

/// Builds the data of a path, with coordinates to a hundredth.
class SvgPath {
  public:
    /// Points beyond [0, most] are moved to its border: plotters draw what is outside of the picture, too.
    explicit SvgPath(const Vec2& most) : most_(most) {}
    void move_to(const Vec2& point) { add('M', point); }
    void line_to(const Vec2& point) { add('L', point); }
    /// A cubic Bezier curve with two control points.
    void curve_to(const Vec2& first, const Vec2& second, const Vec2& point);
    void close() { data_ += 'Z'; }
    const std::string& data() const { return data_; }

  private:
    void add(char command, const Vec2& point);
    void add(const Vec2& point);
    Vec2 most_;
    std::string data_;
};

using SvgAttribute = std::pair<std::string_view, std::string>;

/// Builds an SVG document with one coordinate unit per pixel. Layers are nested by opening and closing them.
class SvgDocument {
  public:
    /// `title` is the document's name in viewers. Throws UsageError unless both sizes are positive.
    SvgDocument(int width, int height, std::string_view title);
    /// Opens a group that Inkscape shows as a layer with this name.
    void open_layer(std::string_view label, std::span<const SvgAttribute> attributes = {});
    void close();
    /// Adds an element without content.
    void add(std::string_view element, std::span<const SvgAttribute> attributes);
    /// Adds a line of text.
    void add_text(std::string_view text, std::span<const SvgAttribute> attributes);
    /// Returns the whole document; throws UsageError if a group is still open.
    std::string text() const;

  private:
    void open(std::string_view element, std::span<const SvgAttribute> attributes, bool empty);
    std::string body_;
    std::size_t depth_ = 0;
    std::size_t layers_ = 0;
    int width_, height_;
    std::string title_;
};

/// Writes a document; readers never see half of it. Throws DataError if it cannot be written.
void write_svg(const std::filesystem::path& path, const SvgDocument& document);

}  // namespace exemplar
