#include "host/hatching/rules/direction_learning.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "host/hatching/rules/held_out_patches.h"

namespace exemplar {
namespace {

constexpr std::size_t k_min_layer_pixels = 50;

/// Directions of strokes and of the rules at the same pixels.
struct StrokeDirectionsOfLayers {
    std::vector<DoubledAngle> stroke;
    std::array<std::vector<DoubledAngle>, k_hatch_layers> rule;
};

StrokeDirectionsOfLayers directions_of(const CorrectedStrokes& strokes, const OrientationFields& fields) {
    StrokeDirectionsOfLayers out;
    for (std::size_t i = 0; i < strokes.rows.size(); ++i) {
        const std::uint32_t row = strokes.rows[i];
        out.stroke.push_back(doubled_angle(strokes.views.drawing_of(row).orientation[strokes.views.pixel_of(row)]));
        for (std::size_t j = 0; j < k_hatch_layers; ++j)
            out.rule[j].push_back(
                strokes.rules[static_cast<std::size_t>(strokes.segment[i])].function[j].evaluate(fields, i));
    }
    return out;
}

/// Returns the layer of each stroke's pixel.
std::vector<std::size_t> layers_of(const CorrectedStrokes& strokes, const StrokeDirectionsOfLayers& directions) {
    std::vector<std::size_t> layers(strokes.rows.size());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const std::uint32_t row = strokes.rows[i];
        if (strokes.views.drawing_of(row).level[strokes.views.pixel_of(row)] != k_cross_hatching) continue;
        const DoubledAngle &stroke = directions.stroke[i], &second_rule = directions.rule[1][i];
        const float first = squared_distance(stroke, directions.rule[0][i]);
        const float second = second_rule == DoubledAngle{} ? 4 - first : squared_distance(stroke, second_rule);
        layers[i] = second < first ? 1 : 0;
    }
    return layers;
}

std::vector<std::uint32_t> all_scalars(const HatchingExamples& views) {
    std::vector<std::uint32_t> all(views.scalar_count());
    std::iota(all.begin(), all.end(), 0U);
    return all;
}

/// Returns the features that corrections are learned from.
QuantizedFeatures quantized_features(const HatchingExamples& views, std::span<const std::uint32_t> rows) {
    QuantizedFeatures quantized = quantize(views.scalars(all_scalars(views), rows), {}, {});
    // Depth tells where in this picture a pixel is, which means nothing in another view.
    const auto depth = std::ranges::find(pixel_feature_names(), std::string("image.depth"));
    quantized.thresholds[static_cast<std::size_t>(depth - pixel_feature_names().begin())].clear();
    return quantized;
}

LearnedCorrection correction_of(std::size_t layer, const CorrectedStrokes& strokes,
                                const StrokeDirectionsOfLayers& directions, std::span<const std::size_t> layers,
                                const std::function<void()>& progress) {
    std::vector<std::uint32_t> rows;
    std::vector<DoubledAngle> targets, rules;
    std::vector<std::int32_t> segments;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (layers[i] != layer) continue;
        rows.push_back(strokes.rows[i]);
        targets.push_back(directions.stroke[i]);
        rules.push_back(directions.rule[layer][i]);
        segments.push_back(strokes.segment[i]);
    }
    if (rows.size() < k_min_layer_pixels) return {};
    const QuantizedFeatures features = quantized_features(strokes.views, rows);
    const OrientationFields fields = strokes.views.orientations(rows);
    return learn_correction({features, fields, targets, rules, segments, strokes.rules.size(),
                             held_out_patches(strokes.views, rows, strokes.seed + 1), strokes.seed},
                            progress);
}

}  // namespace

std::array<LearnedCorrection, k_hatch_layers> learn_corrections(const CorrectedStrokes& strokes,
                                                                const std::function<void()>& progress) {
    const OrientationFields fields = strokes.views.orientations(strokes.rows);
    StrokeDirectionsOfLayers directions = directions_of(strokes, fields);
    const std::vector<std::size_t> layers = layers_of(strokes, directions);
    std::array<LearnedCorrection, k_hatch_layers> out;
    out[0] = correction_of(0, strokes, directions, layers, progress);
    std::vector<DoubledAngle> first = directions.rule[0];
    if (!out[0].correction.empty()) {
        const std::vector<std::uint32_t> which = all_scalars(strokes.views);
        first = corrected_directions(out[0].correction, first, strokes.segment, fields, which,
                                     strokes.views.scalars(which, strokes.rows));
    }
    cross_at_right_angles(first, directions.rule[1]);
    out[1] = correction_of(1, strokes, directions, layers, progress);
    return out;
}

}  // namespace exemplar
