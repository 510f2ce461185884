#include "host/hatching/measurement/drawing_properties.h"

#include <set>

namespace exemplar {

const char* name_of(StrokeProperty property) {
    constexpr std::array<const char*, k_stroke_properties> k_names{"thickness", "intensity", "spacing", "length"};
    return k_names[static_cast<std::size_t>(property)];
}

std::vector<float>& property_of(HatchingFields& fields, StrokeProperty property) {
    const std::array<std::vector<float>*, k_stroke_properties> images{&fields.thickness, &fields.intensity,
                                                                      &fields.spacing, &fields.length};
    return *images[static_cast<std::size_t>(property)];
}

const std::vector<float>& property_of(const HatchingFields& fields, StrokeProperty property) {
    const std::array<const std::vector<float>*, k_stroke_properties> images{&fields.thickness, &fields.intensity,
                                                                            &fields.spacing, &fields.length};
    return *images[static_cast<std::size_t>(property)];
}

namespace {

std::vector<std::uint8_t> on_crossed_strokes(const StrokeMeasurements& measurements) {
    std::set<std::int32_t> crossed;
    for (std::size_t i = 0; i < measurements.size(); ++i)
        if (measurements.intersection[i]) crossed.insert(measurements.stroke_id[i]);
    crossed.erase(-1);  // no stroke
    std::vector<std::uint8_t> on(measurements.size());
    for (std::size_t i = 0; i < on.size(); ++i) on[i] = crossed.contains(measurements.stroke_id[i]) ? 1 : 0;
    return on;
}

}  // namespace

DrawingProperties drawing_properties(const StrokeMeasurements& measurements) {
    DrawingProperties out;
    out.width = measurements.width;
    out.height = measurements.height;
    out.taper = measurements.taper;
    out.outline_width = measurements.outline_width;
    out.known.assign(measurements.size(), 1);
    out.center.resize(measurements.size());
    for (std::size_t i = 0; i < out.center.size(); ++i)
        out.center[i] = measurements.skeleton[i] && measurements.spacing[i] > 0 ? 1 : 0;
    out.crossing = measurements.intersection;
    out.crossed = on_crossed_strokes(measurements);
    out.bounded = measurements.bounded;
    out.orientation = measurements.orientation;
    out.property = {measurements.thickness, measurements.intensity, measurements.spacing, measurements.length};
    out.level = measurements.level;
    out.boundary = measurements.boundary;
    return out;
}

void restrict_to(const PixelMask& mask, DrawingProperties& drawing) {
    for (std::size_t i = 0; i < drawing.known.size(); ++i)
        if (!mask.data[i]) drawing.known[i] = drawing.center[i] = 0;
}

}  // namespace exemplar
