#include "apps/exemplar/hatch/hatch_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/hatching/drawing/drawing_input.h"
#include "host/hatching/drawing/drawing_sheet.h"
#include "host/hatching/drawing/svg_drawing.h"
#include "host/imaging/pictures/picture_file.h"
#include "host/imaging/vectors/svg_reader.h"

namespace exemplar {

namespace {

/// Returns what `read` returns; errors name the file.
template <typename Read>
auto of_drawing(const std::filesystem::path& path, Read&& read) {
    try {
        return read();
    } catch (const DataError& error) {
        const std::string what = error.what();
        const bool named = what.find(path.string()) != std::string::npos;
        throw DataError(named ? what : fmt::format("{}: {}", path.string(), what));
    }
}

/// Returns the drawing of an SVG; none if the file is something else.
std::optional<SvgDrawing> drawing_in_lines(const DrawingFile& file) {
    const std::string content = read_file(file.path);
    if (!is_svg(content)) return std::nullopt;
    if (file.page > 1) throw DataError(fmt::format("has 1 page, so there is no page {}", file.page));
    return svg_drawing(read_svg(content, file.path.string()));
}

AlignedDrawing aligned(const DrawingFile& file, const PixelFeatures& pixels) {
    if (const std::optional<SvgDrawing> lines = drawing_in_lines(file)) return align_and_measure(*lines, pixels);
    return align_and_measure(read_picture(file.path, file.page), pixels);
}

AlignedDrawing measured_on(const DrawingSheet& sheet, const DrawingFile& file, const PixelFeatures& pixels) {
    if (const std::optional<SvgDrawing> lines = drawing_in_lines(file)) return measure_on_sheet(*lines, sheet, pixels);
    return measure_in_place(read_sheet(read_picture(file.path, file.page), sheet), pixels);
}

}  // namespace

FloatImage read_darkness(const DrawingFile& file, int largest_side) {
    FloatImage darkness;
    of_drawing(file.path, [&] {
        const std::optional<SvgDrawing> lines = drawing_in_lines(file);
        const double share = lines ? std::min(1.0, lines->width / lines->height) : 0;
        darkness = lines ? svg_darkness(*lines, std::max(1, static_cast<int>(std::lround(share * largest_side))))
                         : drawing_darkness(read_picture(file.path, file.page));
    });
    return darkness;
}

void add_page_option(Command& command, std::size_t& page) {
    command.add_option("--page", page, "page of the drawing, if it is a TIFF with several; 1 is the first")
        ->type_name("N")
        ->check(whole_number(1));
}

void add_page_option(Command& command, std::vector<std::size_t>& pages, const std::string& drawings) {
    command
        .add_option("--page", pages,
                    "page of the drawing, if it is a TIFF with several; 1 is the first; " + drawings +
                        ", one for each drawing in order")
        ->type_name("N")
        ->allow_extra_args(false)
        ->check(whole_number(1));
}

std::size_t page_of(const std::vector<std::size_t>& pages, std::size_t drawing) {
    return drawing < pages.size() ? pages[drawing] : 0;
}

AlignedDrawing read_drawing(const DrawingFile& file, const HatchSceneArguments& scene, const PixelFeatures& pixels,
                            bool quiet) {
    const std::filesystem::path& path = file.path;
    if (scene.registered) return read_drawing_in_place(file, pixels);
    if (!scene.sheet.empty())
        return of_drawing(path, [&] {
            const DrawingSheet sheet = drawing_sheet(scene.sheet, pixels.view().width, pixels.view().height);
            return measured_on(sheet, file, pixels);
        });
    AlignedDrawing drawing = of_drawing(path, [&] { return aligned(file, pixels); });
    const DrawingAlignment& alignment = drawing.alignment;
    if (!quiet && !alignment.same_frame)
        fmt::print("{}: scaled by {:.3f}, turned by {:.1f} degrees; borders fit to {:.1f} pixels\n", path.string(),
                   alignment.to_view.scale(), alignment.to_view.rotation() * 180 / std::numbers::pi,
                   alignment.residual);
    return drawing;
}

AlignedDrawing read_drawing_in_place(const DrawingFile& file, const PixelFeatures& pixels) {
    return of_drawing(file.path, [&] {
        const std::optional<SvgDrawing> lines = drawing_in_lines(file);
        return lines ? measure_in_place(*lines, pixels) : measure_in_place(read_picture(file.path, file.page), pixels);
    });
}

PixelMask read_mask(const std::filesystem::path& path, const PixelFeatures& pixels) {
    const Image picture = read_picture(path);
    const HatchingView& view = pixels.view();
    if (picture.width != view.width || picture.height != view.height)
        throw DataError(fmt::format("{}: {} x {} pixels; a mask has the view's size, {} x {}", path.string(),
                                    picture.width, picture.height, view.width, view.height));
    PixelMask mask(view.width, view.height, 1);
    bool any = false;
    for (const std::uint32_t pixel : pixels.pixels().pixel) {
        const std::size_t at = pixel * static_cast<std::size_t>(picture.channels);
        mask.data[pixel] = picture.data[at] > 127;
        any = any || mask.data[pixel];
    }
    if (!any) throw DataError(path.string() + ": the mask is black all over the object; make white what counts");
    return mask;
}

}  // namespace exemplar
