#include "host/lines/extraction/line_fields.h"

#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"
#include "host/lines/extraction/view_curvature.h"

namespace exemplar {

namespace {

constexpr std::size_t k_field_grain = 4096;  // vertices that one thread takes at a time

ViewVector view_at(const LineSurface& surface, std::size_t vertex, const LineOptions& options) {
    const Vec3 w = options.to_eye(surface.vertices[vertex]);
    return {surface.curvature.e1[vertex].dot(w), surface.curvature.e2[vertex].dot(w), surface.normals[vertex].dot(w)};
}

template <typename FieldAt>
std::vector<LineField> field_of(const LineSurface& surface, FieldAt&& at) {
    std::vector<LineField> field(surface.vertices.size());
    parallel_for(
        field.size(), [&](std::size_t i) { field[i] = at(i); }, k_field_grain);
    return field;
}

}  // namespace

std::vector<LineField> contour_field(const LineSurface& surface, const LineOptions& options) {
    return field_of(surface, [&](std::size_t i) {
        LineField field;
        field.value = surface.normals[i].dot(options.to_eye(surface.vertices[i]));
        field.strength = field.margin = 1;
        return field;
    });
}

std::vector<LineField> radial_curvature_field(const LineSurface& surface, LineType type, const LineOptions& options) {
    const bool contours = type == LineType::suggestive_contours;
    const float sign = contours ? 1.0f : -1.0f, squared_unit = options.feature_size * options.feature_size;
    const float threshold =
        contours ? options.thresholds.suggestive_contours : options.thresholds.suggestive_highlights;
    return field_of(surface, [&](std::size_t i) {
        const ViewVector view = view_at(surface, i, options);
        const float derivative =
            sign *
            radial_derivative(surface.curvature.k1[i], surface.curvature.k2[i], surface.curvature.derivative[i], view) *
            squared_unit;
        LineField field;
        // Radial curvature times the squared sine has the same zeros and no pole.
        field.value = surface.curvature.k1[i] * view.u * view.u + surface.curvature.k2[i] * view.v * view.v;
        field.margin = derivative - threshold * view.cosine;
        // The cosine is bounded below, as it vanishes at contours.
        field.strength = derivative / std::max(view.cosine, 0.01f);
        field.front = view.cosine;
        return field;
    });
}

std::vector<LineField> principal_highlight_field(const LineSurface& surface, int axis, const LineOptions& options) {
    const VertexCurvature& c = surface.curvature;
    return field_of(surface, [&](std::size_t i) {
        const ViewVector view = view_at(surface, i, options);
        const float k = axis == 0 ? c.k1[i] : c.k2[i], other = axis == 0 ? c.k2[i] : c.k1[i];
        const float across = axis == 0 ? view.v : view.u;
        // Along e1, the derivative of n.w is k1 u, so extrema are the zeros of u. There the second derivative is
        // -k1^2 cos + k1 v g, with g = C112 / (k1 - k2) the rotation of e1 along itself; likewise for e2. Strength
        // is the first term alone: the second only tells maxima from minima, as it is large where e1 is noise.
        const float turn = k == other ? 0.0f : c.derivative[i][axis == 0 ? 1 : 2] / (k - other);
        const float squared_unit = options.feature_size * options.feature_size;
        const float bend = k * k * view.cosine, maximum = bend - k * turn * across;
        LineField field;
        field.value = axis == 0 ? view.u : view.v;
        field.strength = bend * squared_unit;
        field.margin = std::min(field.strength - options.thresholds.principal_highlights, maximum * squared_unit);
        field.front = view.cosine;
        field.direction = axis == 0 ? c.e1[i] : c.e2[i];
        return field;
    });
}

std::vector<LineField> crest_field(const LineSurface& surface, LineType type, const LineOptions& options) {
    const VertexCurvature& c = surface.curvature;
    const float sign = type == LineType::ridges ? 1.0f : -1.0f;
    return field_of(surface, [&](std::size_t i) {
        // The curvature of larger magnitude, with its direction and its derivative along it.
        const bool first = std::abs(c.k1[i]) >= std::abs(c.k2[i]);
        const float k = sign * (first ? c.k1[i] : c.k2[i]), derivative = c.derivative[i][first ? 0 : 3];
        LineField field;
        field.value = k;
        field.strength = k * options.feature_size;
        field.margin = field.strength - options.thresholds.ridges_valleys;
        // Flipping the axis flips the sign of the derivative, so their product does not depend on its sign.
        field.direction = sign * derivative * (first ? c.e1[i] : c.e2[i]);
        if (options.front_facing_only) field.front = surface.normals[i].dot(options.to_eye(surface.vertices[i]));
        return field;
    });
}

}  // namespace exemplar
