// Finds the segments of lines in a face (host/lines/extraction/lines.cpp). The including shader declares
// `positions`, `faces`, `neighbors`, `fields`, `directions`, the constant `k_families` and FaceLineParameters
// `parameters`, and defines what is done with each segment:
//   void emit(uint family, uint first_place, uint second_place, vec3 first_end, vec3 second_end, vec2 strength)
#ifndef EXEMPLAR_FACE_LINES_GLSL
#define EXEMPLAR_FACE_LINES_GLSL
#include "shaders/lib/when.glsl"
#include "shaders/shared/lines.h"

// Shrinks [range.x, range.y] to where the linear function with value `first` at 0 and `last` at 1 is positive.
void clip(float first, float last, inout vec2 range) {
    if (first > 0.0 && last > 0.0) return;
    if (!(first > 0.0) && !(last > 0.0)) {
        range.y = range.x;
        return;
    }
    const float zero = first / (first - last);
    if (first > 0.0)
        range.y = min(range.y, zero);
    else
        range.x = max(range.x, zero);
}

// Emits the part of a segment that faces the eye and passes the threshold. `corners`: fields as columns.
void add_segment(uint family, mat3x4 corners, vec3 a, uint place_a, vec3 b, uint place_b) {
    const vec4 at_a = corners * a, at_b = corners * b;
    vec2 range = vec2(0.0, 1.0);
    clip(at_a.w, at_b.w, range);
    clip(at_a.z, at_b.z, range);
    if (!(range.x < range.y)) return;
    const vec3 first = a + range.x * (b - a), second = a + range.y * (b - a);
    emit(family, range.x > 0.0 ? k_place_inside : place_a, range.y < 1.0 ? k_place_inside : place_b, first, second,
         vec2((corners * first).y, (corners * second).y));
}

vec3 on_side(uint side, float t) {
    vec3 point = vec3(0.0);
    point[side] = 1.0 - t;
    point[side == 2u ? 0u : side + 1u] = t;
    return point;
}

void add_zero_set(uint family, mat3x4 corners, mat3 axes) {
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
    when (any(above) && !all(above)) {
        // Around the face, values become positive on one side and negative on another.
        uint falls = 0, rises = 0;
        for (uint i = 0; i < 3; ++i) {
            const uint next = i == 2u ? 0u : i + 1u;
            if (above[i] && !above[next]) falls = i;
            if (!above[i] && above[next]) rises = i;
        }
        const uint after_falls = falls == 2u ? 0u : falls + 1u, after_rises = rises == 2u ? 0u : rises + 1u;
        add_segment(family, corners, on_side(falls, value[falls] / (value[falls] - value[after_falls])), falls,
                    on_side(rises, value[rises] / (value[rises] - value[after_rises])), rises);
    }
}

void add_extrema(uint family, mat3x4 corners, mat3 growing, mat3 points) {
    when (corners[0].x > 0.0 && corners[1].x > 0.0 && corners[2].x > 0.0) {
        vec3 ends[3];
        uint places[3];
        uint found = 0;
        for (uint i = 0; i < 3; ++i) {
            const uint j = i == 2u ? 0u : i + 1u;
            const vec3 a = growing[i], b = growing[j];
            if (!(dot(a, b) < 0.0 && dot(a - b, points[j] - points[i]) > 0.0)) continue;
            const float at_a = length(a), at_b = length(b);
            ends[found] = on_side(i, at_a / (at_a + at_b));
            places[found++] = i;
        }
        if (found == 2u) add_segment(family, corners, ends[0], places[0], ends[1], places[1]);
        if (found == 3u)
            for (uint i = 0; i < 3; ++i)
                add_segment(family, corners, ends[i], places[i], vec3(1.0 / 3.0), k_place_inside);
    }
}

vec3 face_cross(uvec3 face) {
    const vec3 origin = texelFetch(positions, int(face.x)).xyz;
    return cross(texelFetch(positions, int(face.y)).xyz - origin, texelFetch(positions, int(face.z)).xyz - origin);
}

void add_edges(uint family, uint face, uvec3 corners) {
    const uvec3 across = texelFetch(neighbors, int(face)).xyz;
    for (uint i = 0; i < 3; ++i) {
        float strength = 1.0;
        if (family == k_boundaries) {
            if (across[i] != k_boundary_side) continue;
        } else if (across[i] == k_nonmanifold_side) {
            strength = 3.14159265;
        } else {
            if (across[i] > k_max_side_code || across[i] / 4u < face) continue;
            const vec3 a = face_cross(corners), b = face_cross(texelFetch(faces, int(across[i] / 4u)).xyz);
            if (!(dot(a, a) > 0.0 && dot(b, b) > 0.0)) continue;
            strength = atan(length(cross(a, b)), dot(a, b));
            if (!(strength > parameters.crease_angle)) continue;
        }
        const uint next = i == 2u ? 0u : i + 1u;
        emit(family, k_place_corner + i, k_place_corner + next, on_side(i, 0.0), on_side(next, 0.0), vec2(strength));
    }
}

mat3 three(samplerBuffer source, uint slot, uvec3 corners) {
    const uint begin = slot * parameters.vertices;
    return mat3(texelFetch(source, int(begin + corners.x)).xyz, texelFetch(source, int(begin + corners.y)).xyz,
                texelFetch(source, int(begin + corners.z)).xyz);
}

// Finds the lines of one family in a face; `k_families` decides at compile time whether there are any.
void find_lines_of(uint family, uint face, uvec3 corners) {
    const uint bit = 1u << family, before = bit - 1u;
    if ((k_families & bit) == 0u) return;
    const uint begin = bitCount(k_families & k_field_families & before) * parameters.vertices;
    const mat3x4 field = mat3x4(texelFetch(fields, int(begin + corners.x)), texelFetch(fields, int(begin + corners.y)),
                                texelFetch(fields, int(begin + corners.z)));
    mat3 axes = mat3(0.0);
    if ((bit & k_axis_families) != 0u)
        axes = three(directions, bitCount(k_families & k_axis_families & before), corners);
    if ((bit & k_extremum_families) != 0u)
        add_extrema(family, field, axes, three(positions, 0u, corners));
    else
        add_zero_set(family, field, axes);
}

void find_lines(uint face) {
    const uvec3 corners = texelFetch(faces, int(face)).xyz;
    find_lines_of(k_contours, face, corners);
    find_lines_of(k_suggestive_contours, face, corners);
    find_lines_of(k_suggestive_highlights, face, corners);
    find_lines_of(k_ridges, face, corners);
    find_lines_of(k_valleys, face, corners);
    find_lines_of(k_apparent_ridges, face, corners);
    find_lines_of(k_first_highlights, face, corners);
    find_lines_of(k_second_highlights, face, corners);
    if ((k_families & 1u << k_creases) != 0u) add_edges(k_creases, face, corners);
    if ((k_families & 1u << k_boundaries) != 0u) add_edges(k_boundaries, face, corners);
}

#endif
