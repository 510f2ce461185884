#include "host/hatching/drawing/aligned_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/hatching/drawing/drawing_input.h"

namespace exemplar {

Image object_mask(const PixelFeatures& pixels) {
    Image mask(pixels.view().width, pixels.view().height, 1);
    for (const std::uint32_t pixel : pixels.pixels().pixel) mask.data[pixel] = 1;
    return mask;
}

namespace {

AlignedDrawing measured(const FloatImage& darkness, const DrawingAlignment& alignment, const PixelFeatures& pixels) {
    const HatchingView& view = pixels.view();
    const bool is_view = alignment.same_frame && darkness.width == view.width && darkness.height == view.height;
    FloatImage in_view = is_view ? darkness : warp_drawing(darkness, alignment.to_view, view.width, view.height);
    const ViewOutlines outlines = view_outlines(pixels.gbuffer());
    StrokeMeasurements strokes = measure_strokes(in_view, object_mask(pixels), {}, &outlines);
    return {alignment, std::move(in_view), std::move(strokes)};
}

}  // namespace

AlignedDrawing align_and_measure(const Image& drawing, const PixelFeatures& pixels) {
    const FloatImage darkness = drawing_darkness(drawing);
    return measured(darkness, align_drawing(darkness, object_mask(pixels)), pixels);
}

AlignedDrawing measure_in_place(const Image& drawing, const PixelFeatures& pixels) {
    const HatchingView& view = pixels.view();
    const double scale = static_cast<double>(view.width) / std::max(drawing.width, 1);
    if (std::abs(drawing.height * scale - view.height) > std::max(1.0, 0.01 * view.height))
        throw DataError(fmt::format("{} x {} pixels are not of the view, which has {} x {}", drawing.width,
                                    drawing.height, view.width, view.height));
    DrawingAlignment alignment;
    alignment.to_view = Similarity(scale, 0);
    alignment.same_frame = true;
    return measured(drawing_darkness(drawing), alignment, pixels);
}

Image drawing_template(PixelFeatures& pixels) {
    const std::vector<std::string>& names = pixel_feature_names();
    const auto intensity =
        static_cast<std::uint32_t>(std::ranges::find(names, std::string("image.I@1")) - names.begin());
    const FeatureMatrix bright = pixels.scalars({&intensity, 1}, {});
    Image image(pixels.view().width, pixels.view().height, 1, 255);
    for (std::size_t i = 0; i < bright.rows; ++i) {
        const float value = 70 + 170 * std::clamp(bright.values[i], 0.0f, 1.0f);
        image.data[pixels.pixels().pixel[i]] = static_cast<std::uint8_t>(std::lround(value));
    }
    return image;
}

}  // namespace exemplar
