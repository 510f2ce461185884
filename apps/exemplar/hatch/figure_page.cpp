#include "apps/exemplar/hatch/figure_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/core/files.h"
#include "host/core/text.h"
#include "host/imaging/png.h"
#include "host/imaging/svg.h"
#include "host/mesh/color_text.h"

namespace exemplar {
namespace {

constexpr double k_page_width = 1400, k_margin = 12, k_gap = 8, k_line = 17;
/// Rows with few panels do not fill the page.
constexpr std::size_t k_min_columns = 4;

std::size_t column_count(const Figure& figure) {
    std::size_t columns = k_min_columns;
    for (const auto& row : figure.rows) columns = std::max(columns, row.size());
    return columns;
}

double panel_width(const Figure& figure) {
    const auto columns = static_cast<double>(column_count(figure));
    return (k_page_width - 2 * k_margin - (columns - 1) * k_gap) / columns;
}

double panel_height(const FigurePanel& panel, double width) {
    return width * panel.image.height / panel.image.width;
}

double row_height(std::span<const FigurePanel> row, double width) {
    double height = 0;
    for (const FigurePanel& panel : row) height = std::max(height, panel_height(panel, width));
    return height + k_line + k_gap;
}

double figure_height(const Figure& figure) {
    double height = 2 * k_line + k_line * static_cast<double>(figure.legend.size()) + 2 * k_gap;
    for (const auto& row : figure.rows) height += row_height(row, panel_width(figure));
    return height;
}

/// Lays figures out one below the other.
class FigurePage {
  public:
    FigurePage(const std::filesystem::path& folder, int height)
        : folder_(folder), document_(static_cast<int>(k_page_width), height, "Figures of a hatching style") {
        add_box(0, 0, k_page_width, height, {255, 255, 255});
    }

    void add(const Figure& figure) {
        y_ += k_line;
        add_text(k_margin, y_, 14, figure.title);
        y_ += k_line;
        for (const auto& row : figure.rows) add_row(row, panel_width(figure));
        for (const FigureKey& key : figure.legend) {
            add_box(k_margin, y_, 12, 12, key.color);
            add_text(k_margin + 18, y_ + 10, 12, key.text);
            y_ += k_line;
        }
        y_ += 2 * k_gap;
    }
    const SvgDocument& document() const { return document_; }

  private:
    void add_row(std::span<const FigurePanel> row, double width) {
        double x = k_margin;
        const double below = y_ + row_height(row, width);
        for (const FigurePanel& panel : row) {
            const double height = panel_height(panel, width);
            add_picture(panel, x, width, height);
            add_text(x, y_ + height + 12, 11, panel.caption);
            x += width + k_gap;
        }
        y_ = below;
    }

    void add_picture(const FigurePanel& panel, double x, double width, double height) {
        const std::filesystem::path file = folder_ / (panel.name + ".png");
        write_png(file, panel.image);
        const std::array<SvgAttribute, 5> attributes{{{"x", svg_number(x)},
                                                      {"y", svg_number(y_)},
                                                      {"width", svg_number(width)},
                                                      {"height", svg_number(height)},
                                                      {"href", "data:image/png;base64," + base64(read_file(file))}}};
        document_.add("image", attributes);
    }

    void add_box(double x, double y, double width, double height, const Color& color) {
        const std::array<SvgAttribute, 5> attributes{{{"x", svg_number(x)},
                                                      {"y", svg_number(y)},
                                                      {"width", svg_number(width)},
                                                      {"height", svg_number(height)},
                                                      {"fill", hex_of_color(color)}}};
        document_.add("rect", attributes);
    }

    void add_text(double x, double y, int size, const std::string& text) {
        const std::array<SvgAttribute, 4> attributes{{{"x", svg_number(x)},
                                                      {"y", svg_number(y)},
                                                      {"font-family", "sans-serif"},
                                                      {"font-size", fmt::format("{}", size)}}};
        document_.add_text(text, attributes);
    }

    std::filesystem::path folder_;
    SvgDocument document_;
    double y_ = 0;
};

}  // namespace

void write_figures(const std::filesystem::path& folder, std::span<const Figure> figures) {
    std::filesystem::create_directories(folder);
    double height = k_margin;
    for (const Figure& figure : figures) height += figure_height(figure);
    FigurePage page(folder, static_cast<int>(height));
    for (const Figure& figure : figures) page.add(figure);
    write_svg(folder / "figures.svg", page.document());
}

}  // namespace exemplar
