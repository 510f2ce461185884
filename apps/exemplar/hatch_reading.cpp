#include "apps/exemplar/hatch_reading.h"

#include <fmt/format.h>

#include <numbers>

#include "host/core/errors.h"
#include "host/hatching/drawing_alignment.h"
#include "host/hatching/drawing_input.h"
#include "host/imaging/png.h"

namespace exemplar {

StrokeMeasurements read_drawing(const std::filesystem::path& path, const PixelFeatures& pixels, bool quiet) {
    const HatchingView& view = pixels.view();
    Image mask(view.width, view.height, 1);
    for (const std::uint32_t pixel : pixels.pixels().pixel) mask.data[pixel] = 1;
    try {
        const FloatImage darkness = drawing_darkness(read_png(path));
        const DrawingAlignment alignment = align_drawing(darkness, mask);
        if (!quiet && !alignment.same_frame)
            fmt::print("{}: scaled by {:.3f}, turned by {:.1f} degrees; borders fit to {:.1f} pixels\n", path.string(),
                       alignment.to_view.scale(), alignment.to_view.rotation() * 180 / std::numbers::pi,
                       alignment.residual);
        if (alignment.same_frame && darkness.width == view.width && darkness.height == view.height)
            return measure_strokes(darkness, mask);
        return measure_strokes(warp_drawing(darkness, alignment.to_view, view.width, view.height), mask);
    } catch (const DataError& error) {
        const std::string what = error.what();
        const bool named = what.find(path.string()) != std::string::npos;
        throw DataError(named ? what : fmt::format("{}: {}", path.string(), what));
    }
}

}  // namespace exemplar
