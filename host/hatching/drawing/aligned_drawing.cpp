#include "host/hatching/drawing/aligned_drawing.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "host/hatching/drawing/drawing_input.h"

namespace exemplar {

AlignedDrawing align_and_measure(const Image& drawing, const PixelFeatures& pixels) {
    const HatchingView& view = pixels.view();
    Image mask(view.width, view.height, 1);
    for (const std::uint32_t pixel : pixels.pixels().pixel) mask.data[pixel] = 1;
    const FloatImage darkness = drawing_darkness(drawing);
    const DrawingAlignment alignment = align_drawing(darkness, mask);
    if (alignment.same_frame && darkness.width == view.width && darkness.height == view.height)
        return {alignment, measure_strokes(darkness, mask)};
    return {alignment, measure_strokes(warp_drawing(darkness, alignment.to_view, view.width, view.height), mask)};
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
