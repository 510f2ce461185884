// Finds the segments of lines in a face (host/lines/extraction/lines.cpp). The including shader declares
// `positions`, `faces`, `joined_faces`, `neighbors`, `fields`, `directions`, the constant `k_families` and FaceLineParameters
// `parameters`, and defines in which of the 26 slots of a face to look, and what is done with each segment:
//   #define if_wanted(slots)    nothing, or the condition of the statement behind it
//   void emit(uint slot, uint family, uint first_place, uint second_place, vec3 first_end, vec3 second_end, vec2 strength)
// A slot is a segment that a face may have: one for each zero set, and three each for extrema and edges. They are in the order
// of the segments. `precise` keeps compilers from rounding differently in different kernels.
#ifndef EXEMPLAR_FACE_LINES_GLSL
#define EXEMPLAR_FACE_LINES_GLSL
#include "shaders/lib/eye.glsl"
#include "shaders/shared/lines.h"

const uint k_crease_slot = 14u, k_boundary_slot = 17u, k_edge_contour_slot = 20u;
const uint k_outer_contour_slot = 23u;  // boundaries that are drawn as contours

// Shrinks [range.x, range.y] to where the linear function with value `first` at 0 and `last` at 1 is positive.
void clip(float first, float last, inout vec2 range) {
    if (first > 0.0 && last > 0.0) return;
    if (!(first > 0.0) && !(last > 0.0)) {
        range.y = range.x;
        return;
    }
    precise float zero = first / (first - last);
    if (first > 0.0)
        range.y = min(range.y, zero);
    else
        range.x = max(range.x, zero);
}

// Emits the part of a segment that faces the eye and passes the threshold. `corners`: fields as columns.
void add_segment(uint slot, uint family, mat3x4 corners, vec3 a, uint place_a, vec3 b, uint place_b) {
    precise vec4 at_a = corners * a, at_b = corners * b;
    vec2 range = vec2(0.0, 1.0);
    clip(at_a.w, at_b.w, range);
    clip(at_a.z, at_b.z, range);
    if (!(range.x < range.y)) return;
    const vec3 first = a + range.x * (b - a), second = a + range.y * (b - a);
    emit(slot, family, range.x > 0.0 ? k_place_inside : place_a, range.y < 1.0 ? k_place_inside : place_b, first, second,
         vec2((corners * first).y, (corners * second).y));
}

vec3 on_side(uint side, float t) {
    vec3 point = vec3(0.0);
    point[side] = 1.0 - t;
    point[side == 2u ? 0u : side + 1u] = t;
    return point;
}

void add_zero_set(uint slot, uint family, mat3x4 corners, mat3 axes) {
    vec3 value = vec3(corners[0].x, corners[1].x, corners[2].x);
    if ((1u << family & k_axis_families) != 0u) {
        for (uint i = 1; i < 3; ++i)
            if (dot(axes[0], axes[i]) < 0.0) {
                axes[i] = -axes[i];
                value[i] = -value[i];
            }
        if (dot(axes[1], axes[2]) < 0.0) return;
        float largest = value.x;
        if (abs(value.y) > abs(largest)) largest = value.y;
        if (abs(value.z) > abs(largest)) largest = value.z;
        if (largest < 0.0 && axes[0] != vec3(0.0)) value = -value;
    }
    const bvec3 above = greaterThan(value, vec3(0.0));
    if (any(above) && !all(above)) {
        // Around the face, values become positive on one side and negative on another.
        uint falls = 0, rises = 0;
        for (uint i = 0; i < 3; ++i) {
            const uint next = i == 2u ? 0u : i + 1u;
            if (above[i] && !above[next]) falls = i;
            if (!above[i] && above[next]) rises = i;
        }
        const uint after_falls = falls == 2u ? 0u : falls + 1u, after_rises = rises == 2u ? 0u : rises + 1u;
        precise float at_fall = value[falls] / (value[falls] - value[after_falls]);
        precise float at_rise = value[rises] / (value[rises] - value[after_rises]);
        add_segment(slot, family, corners, on_side(falls, at_fall), falls, on_side(rises, at_rise), rises);
    }
}

void add_extrema(uint slot, uint family, mat3x4 corners, mat3 growing, mat3 points) {
    if (corners[0].x > 0.0 && corners[1].x > 0.0 && corners[2].x > 0.0) {
        vec3 ends[3];
        uint places[3];
        uint found = 0;
        for (uint i = 0; i < 3; ++i) {
            const uint j = i == 2u ? 0u : i + 1u;
            const vec3 a = growing[i], b = growing[j];
            precise float turn = dot(a, b), descent = dot(a - b, points[j] - points[i]);
            if (!(turn < 0.0 && descent > 0.0)) continue;
            precise float at_a = length(a), at_b = length(b), at = at_a / (at_a + at_b);
            ends[found] = on_side(i, at);
            places[found++] = i;
        }
        if (found == 2u) add_segment(slot, family, corners, ends[0], places[0], ends[1], places[1]);
        if (found == 3u)
            for (uint i = 0; i < 3; ++i)
                add_segment(slot + i, family, corners, ends[i], places[i], vec3(1.0 / 3.0), k_place_inside);
    }
}

vec3 face_cross(uvec3 face) {
    const vec3 origin = texelFetch(positions, int(face.x)).xyz;
    return cross(texelFetch(positions, int(face.y)).xyz - origin, texelFetch(positions, int(face.z)).xyz - origin);
}

uint next_side(uint side) {
    return side == 2u ? 0u : side + 1u;
}
vec3 position_of(uvec3 corners, uint corner) {
    return texelFetch(positions, int(corners[corner])).xyz;
}

// Emits the part from x to y of a side.
void emit_side(uint slot, uint family, uint side, vec2 part, float strength) {
    const uint next = next_side(side);
    emit(slot, family, part.x > 0.0 ? k_place_inside : k_place_corner + side,
         part.y < 1.0 ? k_place_inside : k_place_corner + next, on_side(side, part.x), on_side(side, part.y), vec2(strength));
}

// Where a face at an edge lies as the eye sees it, in units of its height over the edge: aside of it in the picture, and
// nearer to the eye (host/lines/extraction/outline_edges.cpp).
vec2 seen_face(vec3 opposite, vec3 origin, vec3 axis, vec3 across) {
    vec3 height = opposite - origin;
    height -= dot(height, axis) * axis;
    return vec2(dot(across, height), dot(cross(across, axis), height)) / max(length(height), 1e-37);
}

// Returns whether the faces at a side and across it are on one side of the edge as the eye sees them.
bool is_outline(uvec3 corners, uint side, uvec3 others, uint other_side) {
    const vec3 origin = position_of(corners, side), end = position_of(corners, next_side(side));
    const vec3 axis = normalize(end - origin);
    const vec3 across = normalize(cross(axis, to_eye(parameters.eye, 0.5 * (origin + end))));
    const vec2 a = seen_face(position_of(corners, next_side(next_side(side))), origin, axis, across);
    const vec2 b = seen_face(position_of(others, next_side(next_side(other_side))), origin, axis, across);
    const bool a_edge_on = !(abs(a.x) > k_edge_on_sine), b_edge_on = !(abs(b.x) > k_edge_on_sine);
    if (a_edge_on) return !b_edge_on && a.y < 0.0;
    if (b_edge_on) return b.y < 0.0;
    return (a.x > 0.0) == (b.x > 0.0);
}

// Returns whether the faces at an edge run along it in opposite directions.
bool oriented_alike(uint face, uint side, uint other, uint other_side) {
    return texelFetch(joined_faces, int(face))[side] != texelFetch(joined_faces, int(other))[other_side];
}

// Returns the part of a sharp side that is a contour, from x to y; none if they are equal.
vec2 contour_along(uvec3 corners, uint side, uvec3 others, uint other_side, uint face, uint other) {
    if (is_outline(corners, side, others, other_side)) return vec2(0.0, 1.0);
    const uint next = next_side(side), other_next = next_side(other_side);
    if (!oriented_alike(face, side, other, other_side)) return vec2(0.0);
    const vec2 own = vec2(texelFetch(fields, int(corners[side])).x, texelFetch(fields, int(corners[next])).x);
    const vec2 across = vec2(texelFetch(fields, int(others[other_next])).x, texelFetch(fields, int(others[other_side])).x);
    const bvec2 faces_eye = greaterThan(own, vec2(0.0)), other_faces_eye = greaterThan(across, vec2(0.0));
    const bvec2 differs = notEqual(faces_eye, other_faces_eye);
    if (all(differs)) return vec2(0.0, 1.0);
    if (!any(differs) && faces_eye.x == faces_eye.y) return vec2(0.0);
    vec2 part = vec2(differs.x ? 0.0 : 1.0, differs.y ? 1.0 : 0.0);
    if (faces_eye.x != faces_eye.y) {
        const float zero = own.x / (own.x - own.y);
        part = vec2(min(part.x, zero), max(part.y, zero));
    }
    if (other_faces_eye.x != other_faces_eye.y) {
        const float zero = across.x / (across.x - across.y);
        part = vec2(min(part.x, zero), max(part.y, zero));
    }
    return part;
}

bool has_neighbor(uint across) {
    return across < k_blocked_side;
}
// Edges with two faces are found in the one of the smaller code.
bool owns_edge(uint face, uint side, uint across) {
    return 4u * face + side < (across & k_max_side_code);
}

void add_creases(uint face, uvec3 corners) {
    const uvec3 sides = texelFetch(neighbors, int(face)).xyz;
    for (uint i = 0; i < 3; ++i) {
        if (!has_neighbor(sides[i]) || !owns_edge(face, i, sides[i])) continue;
        const uint code = sides[i] & k_max_side_code;
        const uvec3 others = texelFetch(faces, int(code / 4u)).xyz;
        float strength = 3.14159265;
        if ((sides[i] & k_crowded_side) == 0u) {
            const vec3 a = face_cross(corners);
            const vec3 b = oriented_alike(face, i, code / 4u, code % 4u) ? face_cross(others) : -face_cross(others);
            if (!(dot(a, a) > 0.0 && dot(b, b) > 0.0)) continue;
            precise float sine = length(cross(a, b)), cosine = dot(a, b);
            strength = atan(sine, cosine);
        }
        if (!(strength > parameters.crease_angle)) continue;
        // On the outline they are contours.
        if ((k_families & 1u << k_edge_contours) != 0u && is_outline(corners, i, others, code % 4u)) continue;
        emit_side(k_crease_slot + i, k_creases, i, vec2(0.0, 1.0), strength);
    }
}

void add_boundaries(uint slot, uint family, uint face) {
    const uvec3 sides = texelFetch(neighbors, int(face)).xyz;
    for (uint i = 0; i < 3; ++i)
        if (sides[i] == k_boundary_side) emit_side(slot + i, family, i, vec2(0.0, 1.0), 1.0);
}

// Boundaries are contours if they are not drawn as such.
void add_edge_contours(uint face, uvec3 corners) {
    const uvec3 sides = texelFetch(neighbors, int(face)).xyz;
    for (uint i = 0; i < 3; ++i) {
        const uint code = sides[i] & k_max_side_code;
        if (has_neighbor(sides[i]) && (sides[i] & k_sharp_side) != 0u && owns_edge(face, i, sides[i])) {
            const uvec3 others = texelFetch(faces, int(code / 4u)).xyz;
            const vec2 part = contour_along(corners, i, others, code % 4u, face, code / 4u);
            if (part.x < part.y) emit_side(k_edge_contour_slot + i, k_edge_contours, i, part, 1.0);
        }
    }
    if ((k_families & 1u << k_boundaries) == 0u) add_boundaries(k_outer_contour_slot, k_edge_contours, face);
}

mat3 three(samplerBuffer source, uint slot, uvec3 corners) {
    const uint begin = slot * parameters.vertices;
    return mat3(texelFetch(source, int(begin + corners.x)).xyz, texelFetch(source, int(begin + corners.y)).xyz,
                texelFetch(source, int(begin + corners.z)).xyz);
}

void find_lines_in_field(uint slot, uint family, uint face, uvec3 corners) {
    const uint bit = 1u << family, before = bit - 1u;
    const uint begin = bitCount(k_families & k_field_families & before) * parameters.vertices;
    const mat3x4 field = mat3x4(texelFetch(fields, int(begin + corners.x)), texelFetch(fields, int(begin + corners.y)),
                                texelFetch(fields, int(begin + corners.z)));
    mat3 axes = mat3(0.0);
    if ((bit & k_axis_families) != 0u)
        axes = three(directions, bitCount(k_families & k_axis_families & before), corners);
    if ((bit & k_extremum_families) != 0u)
        add_extrema(slot, family, field, axes, three(positions, 0u, corners));
    else
        add_zero_set(slot, family, field, axes);
}

// Finds the lines of one family in a face, from its first slot on; `k_families` decides at compile time whether there are any.
void find_lines_of(uint slot, uint family, uint face, uvec3 corners) {
    const uint bit = 1u << family;
    if ((k_families & bit) == 0u) return;
    const uint slots = ((bit & k_extremum_families) != 0u ? 7u : 1u) << slot;
    if_wanted(slots) find_lines_in_field(slot, family, face, corners);
}

void find_lines(uint face) {
    const uvec3 corners = texelFetch(faces, int(face)).xyz;
    find_lines_of(0u, k_contours, face, corners);
    find_lines_of(1u, k_suggestive_contours, face, corners);
    find_lines_of(2u, k_suggestive_highlights, face, corners);
    find_lines_of(3u, k_ridges, face, corners);
    find_lines_of(6u, k_valleys, face, corners);
    find_lines_of(9u, k_apparent_ridges, face, corners);
    find_lines_of(12u, k_first_highlights, face, corners);
    find_lines_of(13u, k_second_highlights, face, corners);
    if ((k_families & 1u << k_creases) != 0u) {
        if_wanted(7u << k_crease_slot) add_creases(face, corners);
    }
    if ((k_families & 1u << k_boundaries) != 0u) add_boundaries(k_boundary_slot, k_boundaries, face);
    if ((k_families & 1u << k_edge_contours) != 0u) {
        if_wanted(7u << k_edge_contour_slot | 7u << k_outer_contour_slot) add_edge_contours(face, corners);
    }
}

#endif
