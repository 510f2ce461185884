#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/eye.glsl"
#include "shaders/shared/lines.h"

// Computes the fields of all families but apparent ridges (host/lines/extraction/line_fields.cpp), one vertex per
// invocation. Reads 80 bytes, without curvature 32; writes 16 per family, and 16 more for its direction.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_families = 0;
layout(push_constant) uniform Push { FieldParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;
layout(set = 0, binding = 1) uniform samplerBuffer normals;
layout(set = 0, binding = 2) uniform samplerBuffer first;  // e1, k1
layout(set = 0, binding = 3) uniform samplerBuffer second;
layout(set = 0, binding = 4) uniform samplerBuffer derivatives;
layout(set = 0, binding = 5, std430) writeonly buffer Fields { vec4 fields[]; };
layout(set = 0, binding = 6, std430) writeonly buffer Directions { vec4 directions[]; };

uint vertex;

bool wants(uint family) {
    return (k_families >> family & 1u) != 0u;
}
uint slot_of(uint family, uint of) {
    return bitCount(k_families & of & ((1u << family) - 1u));
}
float threshold_of(uint family) {
    return family < 4u ? parameters.low_thresholds[family] : parameters.high_thresholds[family - 4u];
}
void put(uint family, vec4 field) {
    fields[slot_of(family, k_field_families) * parameters.vertices + vertex] = field;
}
void put_direction(uint family, vec3 direction) {
    directions[slot_of(family, k_axis_families) * parameters.vertices + vertex] = vec4(direction, 0.0);
}

// The unit vector to the eye: along e1, e2 and the normal.
struct View {
    float u;
    float v;
    float cosine;
};

void put_radial(View view, float k1, float k2, vec4 c) {
    const float u = view.u, v = view.v, squared_sine = u * u + v * v;
    const float value = k1 * u * u + k2 * v * v;
    float derivative = 0.0;
    if (squared_sine > 0.0) {
        const float third = u * u * (u * c.x + 3.0 * v * c.y) + v * v * (3.0 * u * c.z + v * c.w);
        const float torsion = (k2 - k1) * u * v / squared_sine;
        derivative = third / squared_sine - 2.0 * view.cosine * torsion * torsion;
    }
    derivative *= parameters.feature_size * parameters.feature_size;
    const float cosine = max(view.cosine, 0.01);
    if (wants(k_suggestive_contours))
        put(k_suggestive_contours,
            vec4(value, derivative / cosine, derivative - threshold_of(k_suggestive_contours) * view.cosine, view.cosine));
    if (wants(k_suggestive_highlights))
        put(k_suggestive_highlights,
            vec4(value, -derivative / cosine, -derivative - threshold_of(k_suggestive_highlights) * view.cosine, view.cosine));
}

// Uses the curvature of larger magnitude: positive for ridges, negative for valleys.
void put_crests(vec4 e1, vec4 e2, vec4 c) {
    const bool takes_first = abs(e1.w) >= abs(e2.w);
    const float k = takes_first ? e1.w : e2.w;
    const vec3 growing = takes_first ? c.x * e1.xyz : c.w * e2.xyz;
    for (uint family = k_ridges; family <= k_valleys; ++family) {
        if (!wants(family)) continue;
        const float side = family == k_ridges ? 1.0 : -1.0, strength = side * k * parameters.feature_size;
        put(family, vec4(side * k, strength, strength - threshold_of(family), 1.0));
        put_direction(family, side * growing);
    }
}

void put_highlights(uint family, View view, float k, float other, float turning, vec3 axis) {
    const bool along_first = family == k_first_highlights;
    const float across = along_first ? view.v : view.u;
    const float turn = k == other ? 0.0 : turning / (k - other);
    const float squared_unit = parameters.feature_size * parameters.feature_size;
    const float bend = k * k * view.cosine, strength = bend * squared_unit;
    const float maximum = (bend - k * turn * across) * squared_unit;
    put(family, vec4(along_first ? view.u : view.v, strength, min(strength - threshold_of(family), maximum),
                     view.cosine));
    put_direction(family, axis);
}

void main() {
    vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const vec3 here = texelFetch(positions, int(vertex)).xyz, normal = texelFetch(normals, int(vertex)).xyz;
    const vec3 w = to_eye(parameters.eye, here);
    const float cosine = dot(normal, w);
    if (wants(k_contours)) put(k_contours, vec4(cosine, 1.0, 1.0, 1.0));
    if ((k_families & k_curvature_families) == 0u) return;

    const vec4 e1 = texelFetch(first, int(vertex)), e2 = texelFetch(second, int(vertex));
    const vec4 c = texelFetch(derivatives, int(vertex));
    const View view = View(dot(e1.xyz, w), dot(e2.xyz, w), cosine);
    if (wants(k_suggestive_contours) || wants(k_suggestive_highlights)) put_radial(view, e1.w, e2.w, c);
    if (wants(k_ridges) || wants(k_valleys)) put_crests(e1, e2, c);
    if (wants(k_first_highlights)) {
        put_highlights(k_first_highlights, view, e1.w, e2.w, c.y, e1.xyz);
        put_highlights(k_second_highlights, view, e2.w, e1.w, c.z, e2.xyz);
    }
}
