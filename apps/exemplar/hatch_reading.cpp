#include "apps/exemplar/hatch_reading.h"

#include <fmt/format.h>

#include "host/core/errors.h"
#include "host/hatching/drawing_input.h"
#include "host/imaging/png.h"

namespace exemplar {

StrokeMeasurements read_drawing(const std::filesystem::path& path, const PixelFeatures& pixels) {
    const Image drawing = read_png(path);
    const HatchingView& view = pixels.view();
    if (drawing.width != view.width || drawing.height != view.height)
        throw DataError(fmt::format("{}: has {} x {} pixels, the view {} x {}; give --size {}x{}", path.string(),
                                    drawing.width, drawing.height, view.width, view.height, drawing.width,
                                    drawing.height));
    Image mask(view.width, view.height, 1);
    for (const std::uint32_t pixel : pixels.pixels().pixel) mask.data[pixel] = 1;
    return measure_strokes(drawing_darkness(drawing), mask);
}

}  // namespace exemplar
