#include "apps/exemplar/hatch/hatch_reading.h"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "host/core/errors.h"
#include "host/hatching/drawing/aligned_drawing.h"
#include "host/imaging/png.h"

namespace exemplar {

StrokeMeasurements read_drawing(const std::filesystem::path& path, const PixelFeatures& pixels, bool quiet) {
    try {
        AlignedDrawing drawing = align_and_measure(read_png(path), pixels);
        const DrawingAlignment& alignment = drawing.alignment;
        if (!quiet && !alignment.same_frame)
            fmt::print("{}: scaled by {:.3f}, turned by {:.1f} degrees; borders fit to {:.1f} pixels\n", path.string(),
                       alignment.to_view.scale(), alignment.to_view.rotation() * 180 / std::numbers::pi,
                       alignment.residual);
        return std::move(drawing.strokes);
    } catch (const DataError& error) {
        const std::string what = error.what();
        const bool named = what.find(path.string()) != std::string::npos;
        throw DataError(named ? what : fmt::format("{}: {}", path.string(), what));
    }
}

}  // namespace exemplar
