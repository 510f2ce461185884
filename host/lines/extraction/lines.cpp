#include "host/lines/extraction/lines.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/lines/extraction/line_fields.h"
#include "host/lines/extraction/outline_edges.h"

namespace exemplar {

namespace {

constexpr std::size_t k_face_grain = 4096;  // faces that one thread takes at a time

using Barycentric = std::array<float, 3>;
using Corners = std::array<const LineField*, 3>;

/// The segments of one face.
struct FaceLines {
    std::array<LineSegment, 4> segments;  // of contours one in the face and one per side
    std::size_t count = 0;
};

/// Returns the point at t from corner `edge` (0) to the next (1).
Barycentric on_edge(std::size_t edge, float t) {
    Barycentric point{};
    point[edge] = 1 - t;
    point[(edge + 1) % 3] = t;
    return point;
}

float interpolated(const Corners& corners, float LineField::*member, const Barycentric& at) {
    return at[0] * corners[0]->*member + at[1] * corners[1]->*member + at[2] * corners[2]->*member;
}

/// Shrinks the interval [from, to] to where the linear function with value `first` at 0 and `last` at 1 is positive.
void clip(float first, float last, float& from, float& to) {
    if (first > 0 && last > 0) return;
    if (!(first > 0) && !(last > 0)) {
        to = from;
        return;
    }
    const float zero = first / (first - last);
    if (first > 0)
        to = std::min(to, zero);
    else
        from = std::max(from, zero);
}

/// A point of a face with its SegmentEnd.
struct PlacedPoint {
    Barycentric at;
    SegmentEnd place;
};

/// Adds the part of a segment that faces the eye and passes the threshold, if any.
void add_segment(const Corners& corners, const PlacedPoint& first, const PlacedPoint& second, FaceLines& lines) {
    const Barycentric &a = first.at, &b = second.at;
    float from = 0, to = 1;
    for (float LineField::*const member : {&LineField::front, &LineField::margin})
        clip(interpolated(corners, member, a), interpolated(corners, member, b), from, to);
    if (!(from < to)) return;
    LineSegment& segment = lines.segments[lines.count++];
    segment.places = {from > 0 ? k_inside_face : first.place, to < 1 ? k_inside_face : second.place};
    for (std::size_t i = 0; i < 3; ++i) {
        segment.ends[0][i] = a[i] + from * (b[i] - a[i]);
        segment.ends[1][i] = a[i] + to * (b[i] - a[i]);
    }
    for (std::size_t end : {0, 1})
        segment.strength[end] = interpolated(corners, &LineField::strength, segment.ends[end]);
}

/// Adds the zero set of `value` in a face.
void add_zero_set(const Corners& corners, FaceLines& lines) {
    std::array<float, 3> value;
    std::array<Vec3, 3> axis;
    for (std::size_t i = 0; i < 3; ++i) {
        axis[i] = corners[i]->direction;
        value[i] = corners[i]->value;
        if (i == 0 || !(axis[0].dot(axis[i]) < 0)) continue;
        axis[i] = -axis[i];
        value[i] = -value[i];
    }
    if (axis[1].dot(axis[2]) < 0) return;  // around an umbilic no choice of signs is continuous
    // The result must not depend on the sign of the first axis, which decides on which side zeros at vertices count.
    const auto by_size = [](float a, float b) { return std::abs(a) < std::abs(b); };
    if (axis[0] != Vec3::Zero() && *std::max_element(value.begin(), value.end(), by_size) < 0)
        for (float& v : value) v = -v;
    // Around the face, values become positive on one side and negative on another, or on none.
    std::optional<PlacedPoint> falls, rises;
    for (std::size_t i = 0; i < 3; ++i) {
        const float a = value[i], b = value[(i + 1) % 3];
        if ((a > 0) == (b > 0)) continue;
        (a > 0 ? falls : rises) = PlacedPoint{on_edge(i, a / (a - b)), static_cast<SegmentEnd>(i)};
    }
    if (falls && rises) add_segment(corners, *falls, *rises, lines);
}

/// Adds the maxima along `direction` in a face (Ohtake et al. 2004): they cross an edge if the directions at its
/// ends are opposed and point to each other.
void add_extrema(const Corners& corners, const std::array<Vec3, 3>& points, FaceLines& lines) {
    std::array<PlacedPoint, 3> ends;
    std::size_t found = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(corners[i]->value > 0)) return;
        const std::size_t j = (i + 1) % 3;
        const Vec3 &a = corners[i]->direction, &b = corners[j]->direction;
        if (!(a.dot(b) < 0 && (a - b).dot(points[j] - points[i]) > 0)) continue;
        const float at_a = a.norm(), at_b = b.norm();
        ends[found++] = {on_edge(i, at_a / (at_a + at_b)), static_cast<SegmentEnd>(i)};
    }
    constexpr PlacedPoint k_center{{1.0f / 3, 1.0f / 3, 1.0f / 3}, k_inside_face};
    if (found == 2) add_segment(corners, ends[0], ends[1], lines);
    if (found == 3)
        for (const PlacedPoint& end : ends) add_segment(corners, end, k_center, lines);
}

/// Returns the normal of a face, with twice its area as length.
Vec3 face_cross(const LineSurface& surface, std::size_t face) {
    const auto& [a, b, c] = surface.faces[face];
    const Vec3& origin = surface.vertices[a];
    return (surface.vertices[b] - origin).cross(surface.vertices[c] - origin);
}

/// Returns the angle between the normals of the faces at a side, one of them turned around if they are not oriented
/// alike, or zero if one is degenerate and has no normal.
float angle_across(const LineSurface& surface, std::uint32_t f, std::uint32_t side, std::uint32_t across) {
    const Vec3 a = face_cross(surface, f);
    Vec3 b = face_cross(surface, neighbor_face(across));
    if (!oriented_alike(surface.joined_faces(), f, side, across)) b = -b;
    if (!(a.squaredNorm() > 0) || !(b.squaredNorm() > 0)) return 0;
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Adds a part of side `i` of a face.
void add_side(std::size_t i, const SidePart& part, float strength, std::uint8_t family, FaceLines& lines) {
    LineSegment& segment = lines.segments[lines.count++];
    segment.family = family;
    for (std::size_t end : {0, 1}) {
        const float at = end == 0 ? part.from : part.to;
        segment.ends[end] = on_edge(i, at);
        segment.places[end] = k_inside_face;
        if (at == 0 || at == 1)
            segment.places[end] = static_cast<SegmentEnd>(k_at_corner + (at == 0 ? i : (i + 1) % 3));
        segment.strength[end] = strength;
    }
}

/// Adds the sides of face `f` that are creases or boundaries.
void add_edges(const LineSurface& surface, std::uint32_t f, LineType type, const LineOptions& options,
               FaceLines& lines) {
    for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t across = surface.neighbors[f][i];
        float strength = 1;
        if (type == LineType::boundaries) {
            if (across != k_no_neighbor) continue;
        } else {
            if (!has_neighbor(across) || !owns_edge(f, i, across)) continue;
            const bool crowded = (across & k_crowded_side) != 0;
            strength = crowded ? std::numbers::pi_v<float> : angle_across(surface, f, i, across);
            if (!(strength > options.thresholds.crease_angle)) continue;
            if (options.no_creases_on_outline && is_outline(surface, f, i, options)) continue;
        }
        add_side(i, {0, 1}, strength, 0, lines);
    }
}

/// Adds the parts of the sides of face `f` that are contours.
void add_contour_edges(const LineSurface& surface, std::uint32_t f, const LineOptions& options, FaceLines& lines) {
    for (std::uint32_t i = 0; i < 3; ++i) {
        const std::uint32_t across = surface.neighbors[f][i];
        SidePart part;
        if (across == k_no_neighbor)
            part.to = options.contours_at_boundaries ? 1 : 0;
        else if (has_neighbor(across) && (across & k_sharp_side) && owns_edge(f, i, across))
            part = contour_along(surface, f, i, options);
        if (part.from < part.to) add_side(i, part, 1, k_family_along_edges, lines);
    }
}

bool is_extremum(LineType type) {
    return type == LineType::ridges || type == LineType::valleys || type == LineType::apparent_ridges;
}

/// Computes one field per family of lines; principal highlights have two.
std::vector<std::vector<LineField>> fields_of(const LineSurface& surface, LineType type, const LineOptions& options) {
    switch (type) {
        case LineType::contours:
            return {contour_field(surface, options)};
        case LineType::suggestive_contours:
        case LineType::suggestive_highlights:
            return {radial_curvature_field(surface, type, options)};
        case LineType::ridges:
        case LineType::valleys:
            return {crest_field(surface, type, options)};
        case LineType::apparent_ridges:
            return {apparent_ridge_field(surface, options)};
        case LineType::principal_highlights:
            return {principal_highlight_field(surface, 0, options), principal_highlight_field(surface, 1, options)};
        case LineType::creases:
        case LineType::boundaries:
            break;  // have no field
    }
    return {};
}

void check_line_type(const LineSurface& surface, LineType type, const LineOptions& options) {
    const std::size_t count = surface.vertices.size();
    const VertexCurvature& c = surface.curvature;
    const auto expect = [&](std::size_t have, const char* what) {
        if (have != count)
            throw UsageError(fmt::format("{} {} for {} vertices: compute them for the same mesh", have, what, count));
    };
    if (type == LineType::creases || type == LineType::boundaries) {
        if (surface.neighbors.size() != surface.faces.size())
            throw UsageError(fmt::format("neighbors of {} faces for {}: compute them for the same mesh",
                                         surface.neighbors.size(), surface.faces.size()));
        return;
    }
    expect(surface.normals.size(), "normals");
    if (!needs_curvature(type)) return;
    for (const std::size_t have : {c.k1.size(), c.k2.size(), c.e1.size(), c.e2.size()}) expect(have, "curvatures");
    expect(c.derivative.size(), "derivatives of curvature");
    if (!(options.feature_size > 0 && std::isfinite(options.feature_size)))
        throw UsageError(fmt::format("a feature size of {}: give a positive length", options.feature_size));
}

/// Calls use(f, lines of face f) for all faces, in parallel.
template <typename Use>
void for_each_face(const LineSurface& surface, LineType type, const LineOptions& options, Use&& use) {
    check_line_type(surface, type, options);
    const std::vector<std::vector<LineField>> fields = fields_of(surface, type, options);
    const bool extremum = is_extremum(type);
    parallel_for(
        surface.faces.size(),
        [&](std::size_t f) {
            const auto& [a, b, c] = surface.faces[f];
            FaceLines lines;
            if (fields.empty()) add_edges(surface, static_cast<std::uint32_t>(f), type, options, lines);
            for (std::size_t family = 0; family < fields.size(); ++family) {
                const std::vector<LineField>& field = fields[family];
                const Corners corners = {&field[a], &field[b], &field[c]};
                const std::size_t before = lines.count;
                if (extremum)
                    add_extrema(corners, {surface.vertices[a], surface.vertices[b], surface.vertices[c]}, lines);
                else
                    add_zero_set(corners, lines);
                for (std::size_t i = before; i < lines.count; ++i)
                    lines.segments[i].family = static_cast<std::uint8_t>(family);
            }
            if (type == LineType::contours && !surface.neighbors.empty())
                add_contour_edges(surface, static_cast<std::uint32_t>(f), options, lines);
            use(f, lines);
        },
        k_face_grain);
}

}  // namespace

std::vector<std::uint8_t> classify_faces(const LineSurface& surface, LineType type, const LineOptions& options) {
    std::vector<std::uint8_t> carries(surface.faces.size(), 0);
    for_each_face(surface, type, options,
                  [&](std::size_t f, const FaceLines& lines) { carries[f] = lines.count > 0 ? 1 : 0; });
    return carries;
}

std::vector<LineSegment> extract_lines(const LineSurface& surface, LineType type, const LineOptions& options) {
    std::vector<FaceLines> by_face(surface.faces.size());
    for_each_face(surface, type, options, [&](std::size_t f, const FaceLines& lines) { by_face[f] = lines; });
    std::vector<LineSegment> segments;
    for (std::size_t f = 0; f < by_face.size(); ++f)
        for (std::size_t i = 0; i < by_face[f].count; ++i) {
            segments.push_back(by_face[f].segments[i]);
            segments.back().face = static_cast<std::uint32_t>(f);
        }
    return segments;
}

}  // namespace exemplar
