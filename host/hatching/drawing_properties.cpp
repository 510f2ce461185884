#include "host/hatching/drawing_properties.h"

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

DrawingProperties drawing_properties(const StrokeMeasurements& measurements) {
    DrawingProperties out;
    out.width = measurements.width;
    out.height = measurements.height;
    out.center.resize(measurements.size());
    for (std::size_t i = 0; i < out.center.size(); ++i)
        out.center[i] = measurements.skeleton[i] && measurements.spacing[i] > 0 ? 1 : 0;
    out.crossing = measurements.intersection;
    out.orientation = measurements.orientation;
    out.property = {measurements.thickness, measurements.intensity, measurements.spacing, measurements.length};
    out.level = measurements.level;
    out.boundary = measurements.boundary;
    return out;
}

}  // namespace exemplar
