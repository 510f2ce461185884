#include "host/synth/hatching/hand_picked_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "host/core/statistics.h"

namespace exemplar {
namespace {

constexpr std::array<HandPickedRule, 3> k_hand_picked_rules{
    {{"principal curvature", "k_max,3"}, {"local PCA axes", "e_a,3"}, {"gradient of intensity", "grad I,4"}}};

std::uint32_t number_of(const std::vector<std::string>& names, std::string_view name) {
    return static_cast<std::uint32_t>(std::ranges::find(names, name) - names.begin());
}

/// Returns the drawing's number of the object's pixels of each level.
std::array<std::size_t, 3> level_counts(const PixelFeatures& pixels, const DrawingProperties& drawing) {
    std::array<std::size_t, 3> counts{};
    for (const std::uint32_t pixel : pixels.pixels().pixel) ++counts[drawing.level[pixel]];
    return counts;
}

/// Fills levels: the more a pixel faces away from the eye, the darker.
void threshold_levels(PixelFeatures& pixels, const std::array<std::size_t, 3>& counts, HatchingFields& fields) {
    const std::array<std::uint32_t, 1> facing{number_of(pixel_feature_names(), "image.V.N@1")};
    const FeatureMatrix values = pixels.scalars(facing, {});
    std::vector<std::uint32_t> order(pixels.size());
    for (std::uint32_t row = 0; row < order.size(); ++row) order[row] = row;
    std::ranges::stable_sort(order, {}, [&](std::uint32_t row) { return values.column(0)[row]; });
    for (std::size_t i = 0; i < counts[2] + counts[1]; ++i)
        fields.level[pixels.pixels().pixel[order[i]]] = i < counts[2] ? k_cross_hatching : k_single_hatching;
}

void point_along(std::uint32_t feature, PixelFeatures& pixels, HatchingFields& fields) {
    constexpr float k_half_turn = std::numbers::pi_v<float>;
    const OrientationFields directions = pixels.orientations({});
    for (std::size_t row = 0; row < pixels.size(); ++row) {
        const std::uint32_t pixel = pixels.pixels().pixel[row];
        const DoubledAngle direction = directions.feature(feature, row);
        if (direction == DoubledAngle{}) fields.level[pixel] = k_no_hatching;
        const float angle = angle_of(direction);
        fields.orientation[0][pixel] = angle;
        fields.orientation[1][pixel] = std::fmod(angle + k_half_turn / 2, k_half_turn);
    }
}

/// Returns the median of a property over the drawing's center lines; at least a small positive number.
float median_of_strokes(const DrawingProperties& drawing, StrokeProperty property) {
    const std::vector<float>& all = drawing.property[static_cast<std::size_t>(property)];
    std::vector<float> values;
    for (std::size_t p = 0; p < all.size(); ++p)
        if (drawing.center[p] && all[p] > 0) values.push_back(all[p]);
    return values.empty() ? 1 : upper_median(values);
}

}  // namespace

std::span<const HandPickedRule> hand_picked_rules() {
    return k_hand_picked_rules;
}

HatchingFields hatching_by_hand_picked_rule(const HandPickedRule& rule, PixelFeatures& pixels,
                                            const DrawingProperties& drawing) {
    HatchingFields fields(pixels.view().width, pixels.view().height);
    threshold_levels(pixels, level_counts(pixels, drawing), fields);
    point_along(number_of(orientation_feature_names(), rule.direction), pixels, fields);
    for (std::size_t p = 0; p < k_stroke_properties; ++p) {
        const auto property = static_cast<StrokeProperty>(p);
        std::ranges::fill(property_of(fields, property), median_of_strokes(drawing, property));
    }
    return fields;
}

}  // namespace exemplar
