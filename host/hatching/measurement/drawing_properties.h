#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host/hatching/fields/hatching_fields.h"
#include "host/hatching/measurement/stroke_measurements.h"

namespace exemplar {

/// The real-valued properties of strokes (thesis Sec. 4.3.3).
enum class StrokeProperty { thickness, intensity, spacing, length };
constexpr std::size_t k_stroke_properties = 4;
/// Returns "thickness" and so on.
const char* name_of(StrokeProperty property);
/// Returns the image of a property.
std::vector<float>& property_of(HatchingFields& fields, StrokeProperty property);
const std::vector<float>& property_of(const HatchingFields& fields, StrokeProperty property);

/// The properties of a drawing at each pixel of the view that it shows; all are images of the view's size.
struct DrawingProperties {
    int width = 0, height = 0;
    float taper = 0;                     ///< pixels over which strokes end in a point
    float outline_width = 0;             ///< pixels; 0: no outlines are drawn
    std::vector<std::uint8_t> known;     ///< 1: the drawing says what is there, hatching or none
    std::vector<std::uint8_t> center;    ///< 1: on the center line of a hatching stroke, where properties are known
    std::vector<std::uint8_t> crossing;  ///< 1: where strokes cross, so that the direction is unknown
    std::vector<std::uint8_t> crossed;   ///< 1: on a stroke that crosses another, so its length is uncertain
    std::vector<std::uint8_t> bounded;  ///< 1: on a stroke as long as its hatching is wide: its length is a lower bound
    std::vector<float> orientation;     ///< radians in [0, pi)
    std::array<std::vector<float>, k_stroke_properties> property;  ///< positive where known
    std::vector<std::uint8_t> level;                               ///< of every pixel of the object
    std::vector<std::uint8_t> boundary;                            ///< 1: on a boundary of hatching regions
};

/// Returns measurements in the form that styles are learned from. Strokes without a neighbor along them are no
/// hatching and left out.
DrawingProperties drawing_properties(const StrokeMeasurements& measurements);

/// Restricts what is learned from a drawing to the pixels of a mask of its size.
void restrict_to(const PixelMask& mask, DrawingProperties& drawing);

}  // namespace exemplar
