#include "gpu/lines/device_style.h"

#include <cmath>
#include <map>
#include <string>

#include "host/lines/strokes/stroke_textures.h"

namespace exemplar {
namespace {

/// Collects textures; those that several types share are stored once. StrokeLook::texture is 1 + first texel.
class Textures {
  public:
    struct Place {
        std::uint32_t texture;
        float period;
    };
    Place place_of(const std::string& name) {
        const auto known = places_.find(name);
        if (known != places_.end()) return known->second;
        const Image image = load_stroke_texture(name);
        Place place{0, float(shared::k_texture_width)};
        if (image.width > 0) {
            place = {static_cast<std::uint32_t>(texels_.size()) + 1, static_cast<float>(image.width)};
            append(image);
        }
        places_[name] = place;
        return place;
    }
    std::vector<std::uint8_t> texels() const { return texels_; }

  private:
    // Resamples images of other sizes at the centers of the texels.
    void append(const Image& image) {
        for (std::uint32_t y = 0; y < shared::k_texture_height; ++y)
            for (std::uint32_t x = 0; x < shared::k_texture_width; ++x) {
                const float along = (static_cast<float>(x) + 0.5f) / float(shared::k_texture_width);
                const float across = (static_cast<float>(y) + 0.5f) / float(shared::k_texture_height);
                const float opacity =
                    sample_stroke_texture(image, along * static_cast<float>(image.width), 2 * across - 1);
                texels_.push_back(static_cast<std::uint8_t>(std::lround(255 * opacity)));
            }
    }
    std::map<std::string, Place> places_;
    std::vector<std::uint8_t> texels_;
};

shared::StrokeLook look_of(const LineStyle& line, float threshold, float fade, Textures& textures) {
    const Textures::Place texture = textures.place_of(line.texture);
    return {.color = {static_cast<float>(line.color[0]) / 255, static_cast<float>(line.color[1]) / 255,
                      static_cast<float>(line.color[2]) / 255, line.opacity},
            .width = line.thickness.width,
            .epsilon = line.thickness.epsilon,
            .least = line.thickness.least,
            .most = line.thickness.most,
            .taper = line.thickness.taper,
            .threshold = threshold,
            .fade = fade,
            .texture = texture.texture,
            .period = texture.period};
}

SurfaceLight light_of(SurfaceShading shading) {
    switch (shading) {
        case SurfaceShading::shaded:
            return SurfaceLight::headlight;
        case SurfaceShading::toon:
            return SurfaceLight::steps;
        case SurfaceShading::none:
        case SurfaceShading::paper:
            break;
    }
    return SurfaceLight::none;
}

PaintLook surface_look(const DrawingStyle& style) {
    const Color background = style.background.value_or(Color{255, 255, 255});
    const bool none = style.shading == SurfaceShading::none;
    return {.light = light_of(style.shading),
            .plain = none ? background : style.surface,
            .background = background,
            .transparent = !style.background,
            .transparent_plain = none};
}

}  // namespace

DeviceStyle device_style(const DrawingStyle& style) {
    DeviceStyle result;
    Textures textures;
    for (std::uint32_t family = 0; family < shared::k_line_families; ++family) {
        const LineType type = type_of_family(family);
        const LineThresholds thresholds = style.thresholds(type);
        result.thresholds[family] = family_thresholds(thresholds)[family];
        const auto fading = line_fading(type, thresholds);
        result.looks[family] =
            look_of(style.of(type), fading ? fading->threshold : 0, fading ? fading->half : 0, textures);
    }
    result.surface = surface_look(style);
    result.textures = textures.texels();
    return result;
}

void apply_style(const DeviceStyle& style, std::span<const LineType> types, LinePicture& picture) {
    picture.families = line_families(types);
    picture.thresholds = style.thresholds;
    picture.looks = style.looks;
    picture.surface = style.surface;
}

}  // namespace exemplar
