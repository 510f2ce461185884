#include "host/hatching/drawing/drawing_sheet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/hatching/drawing/plane_map.h"
#include "host/hatching/drawing/sheet_marks.h"

namespace exemplar {
namespace {

using Eigen::Vector2d;

constexpr double k_pixels_per_mm = 300 / 25.4;
constexpr double k_mark_inset = 14;  ///< mm from the paper's edges to the centers of marks: printers leave a margin
constexpr double k_view_inset = 22;
constexpr int k_scale_length = 100;  ///< mm
/// Light blue: 'non-photo' blue, which is seen when drawing and dropped when reading.
constexpr std::array<double, 3> k_pale_blue{164, 221, 237};

struct PaperSize {
    const char* name;
    double width, height;  ///< mm
};
constexpr std::array<PaperSize, 6> k_papers{{{"a3", 297, 420},
                                             {"a4", 210, 297},
                                             {"a5", 148, 210},
                                             {"letter", 215.9, 279.4},
                                             {"legal", 215.9, 355.6},
                                             {"tabloid", 279.4, 431.8}}};

/// Fills what `covered` says of the pixels around a place with a color.
template <typename Covered>
void fill(Image& image, const Vector2d& low, const Vector2d& high, std::uint8_t gray, const Covered& covered) {
    for (int y = std::max(0, static_cast<int>(low.y())); y < std::min<double>(image.height, high.y() + 1); ++y)
        for (int x = std::max(0, static_cast<int>(low.x())); x < std::min<double>(image.width, high.x() + 1); ++x)
            if (covered(Vector2d(x + 0.5, y + 0.5))) std::ranges::fill(image.pixel(x, y), gray);
}

void draw_disc(Image& image, const Vector2d& center, double radius, std::uint8_t gray) {
    const Vector2d reach = Vector2d::Constant(radius);
    fill(image, center - reach, center + reach, gray, [&](const Vector2d& p) { return (p - center).norm() <= radius; });
}

void draw_box(Image& image, const Vector2d& low, const Vector2d& high) {
    fill(image, low, high, 0,
         [&](const Vector2d& p) { return (p.array() >= low.array()).all() && (p.array() <= high.array()).all(); });
}

/// A line with a tick at each centimeter, longer at each fifth.
void draw_scale(Image& image, const DrawingSheet& sheet) {
    const double mm = sheet.pixels_per_mm;
    const Vector2d left(0.5 * sheet.width - 0.5 * k_scale_length * mm, sheet.height - k_mark_inset * mm);
    draw_box(image, left, left + Vector2d(k_scale_length * mm, 0.25 * mm));
    for (int at = 0; at <= k_scale_length; at += 10) {
        const double height = at % 50 == 0 ? 3 : 1.5;
        const Vector2d foot = left + Vector2d(at * mm, 0);
        draw_box(image, foot - Vector2d(0.12 * mm, height * mm), foot + Vector2d(0.12 * mm, 0.25 * mm));
    }
}

Vector2d on_sheet(const DrawingSheet& sheet, const Vector2d& view) {
    return sheet.view_corner + sheet.view_scale * view;
}

}  // namespace

const std::vector<std::string>& paper_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        all.reserve(k_papers.size());
        for (const PaperSize& paper : k_papers) all.emplace_back(paper.name);
        return all;
    }();
    return names;
}

DrawingSheet drawing_sheet(const std::string& paper, int view_width, int view_height) {
    const auto found = std::ranges::find(k_papers, paper, &PaperSize::name);
    if (found == k_papers.end())
        throw UsageError(fmt::format("paper '{}' is unknown; there are {}", paper, fmt::join(paper_names(), ", ")));
    if (view_width <= 0 || view_height <= 0) throw UsageError("the view has no pixels");
    const bool across = view_width > view_height;
    DrawingSheet sheet;
    sheet.pixels_per_mm = k_pixels_per_mm;
    const double w = (across ? found->height : found->width) * k_pixels_per_mm;
    const double h = (across ? found->width : found->height) * k_pixels_per_mm;
    sheet.width = static_cast<int>(std::lround(w));
    sheet.height = static_cast<int>(std::lround(h));
    sheet.view_width = view_width;
    sheet.view_height = view_height;
    const double inset = k_view_inset * k_pixels_per_mm, mark = k_mark_inset * k_pixels_per_mm;
    sheet.view_scale = std::min((w - 2 * inset) / view_width, (h - 2 * inset) / view_height);
    sheet.view_corner = 0.5 * (Vector2d(w, h) - sheet.view_scale * Vector2d(view_width, view_height));
    sheet.marks = {Vector2d(mark, mark), Vector2d(w - mark, mark), Vector2d(w - mark, h - mark),
                   Vector2d(mark, h - mark)};
    return sheet;
}

Image printed_sheet(const DrawingSheet& sheet, const Image& view) {
    if (view.channels != 1 || view.width != sheet.view_width || view.height != sheet.view_height)
        throw UsageError("the view to print is not of the sheet's size, or not gray");
    Image page(sheet.width, sheet.height, 3, 255);
    for (int y = 0; y < page.height; ++y)
        for (int x = 0; x < page.width; ++x) {
            const Vector2d place = (Vector2d(x + 0.5, y + 0.5) - sheet.view_corner) / sheet.view_scale;
            if (place.x() < 0 || place.y() < 0 || place.x() >= view.width || place.y() >= view.height) continue;
            const double dark = 1 - mean_at(view, place, 1 / sheet.view_scale)[0] / 255;
            for (std::size_t c = 0; c < 3; ++c)
                page.pixel(x, y)[c] =
                    static_cast<std::uint8_t>(std::lround(255 - std::min(1.0, 1.4 * dark) * (255 - k_pale_blue[c])));
        }
    for (std::size_t i = 0; i < sheet.marks.size(); ++i) {
        const double mm = sheet.pixels_per_mm;
        draw_disc(page, sheet.marks[i], k_mark_radius * mm, 0);
        draw_disc(page, sheet.marks[i], k_mark_hole * mm, 255);
        if (i > 0) draw_disc(page, sheet.marks[i], k_mark_dot * mm, 0);
    }
    draw_scale(page, sheet);
    return page;
}

Image read_sheet(const Image& picture, const DrawingSheet& sheet) {
    const auto marks = find_marks(picture);
    if (!marks)
        throw DataError(
            "the four rings in the corners of the sheet are not all seen; show the whole sheet, sharp and not too "
            "aslant, with nothing on the rings");
    const PlaneMap to_picture(sheet.marks, *marks);
    const Vector2d middle(0.5 * sheet.view_width, 0.5 * sheet.view_height);
    const auto place_of = [&](const Vector2d& view) { return to_picture.apply(on_sheet(sheet, view)); };
    const double resolution = (place_of(middle + Vector2d(0.5, 0)) - place_of(middle - Vector2d(0.5, 0))).norm();
    constexpr double k_finest = 4;
    const double finer = std::clamp(std::ceil(resolution), 1.0, k_finest);
    Image view(static_cast<int>(finer * sheet.view_width), static_cast<int>(finer * sheet.view_height),
               picture.channels);
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            const auto value = mean_at(picture, place_of(Vector2d(x + 0.5, y + 0.5) / finer), resolution / finer);
            for (int c = 0; c < picture.channels; ++c)
                view.pixel(x, y)[static_cast<std::size_t>(c)] =
                    static_cast<std::uint8_t>(std::lround(value[static_cast<std::size_t>(c)]));
        }
    return view;
}

}  // namespace exemplar
