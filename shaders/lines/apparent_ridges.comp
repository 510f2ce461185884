#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"
#include "shaders/shared/lines.h"

// Computes the field of apparent ridges (host/lines/extraction/apparent_ridges.cpp), one vertex per invocation: the
// derivative of view-dependent curvature along its direction, from the faces that the direction leads into. Per
// vertex with six faces 4 + 32 bytes of topology and 64 of its own are read and 32 written; the data of the ring
// comes from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_families = 0;
layout(push_constant) uniform Push { FieldParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;
layout(set = 0, binding = 1) uniform samplerBuffer first;
layout(set = 0, binding = 2) uniform samplerBuffer second;
layout(set = 0, binding = 3) uniform samplerBuffer views;
layout(set = 0, binding = 4) uniform usamplerBuffer ring_begin;
layout(set = 0, binding = 5) uniform usamplerBuffer rings;
layout(set = 0, binding = 6, std430) writeonly buffer Fields { vec4 fields[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Directions { vec4 directions[]; };

float cross2(vec2 a, vec2 b) {
    return a.x * b.y - a.y * b.x;
}

// Returns sum and number of the difference quotients in a face, if the direction, forward or backward, leads into
// it. to_a, to_b: edges from the vertex to the other corners, in (e1, e2).
vec2 slope_in(vec3 here, vec2 to_a, vec2 to_b, float q_a, float q_b) {
    vec2 slope = vec2(0.0);
    for (float side = 1.0; side >= -1.0; side -= 2.0) {
        const vec2 direction = side * here.yz;
        const float beside_a = cross2(to_a, direction), beside_b = cross2(direction, to_b);
        if (!(beside_a >= 0.0 && beside_b > 0.0)) continue;
        const float t = beside_a / (beside_a + beside_b);
        const float on_screen = dot(to_a + t * (to_b - to_a), direction) / dot(direction, direction);
        if (!(on_screen > 0.0)) continue;
        slope += vec2(side * (q_a + t * (q_b - q_a) - here.x) / on_screen, 1.0);
    }
    return slope;
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const vec4 view = texelFetch(views, int(vertex));
    const vec3 here = texelFetch(positions, int(vertex)).xyz;
    const vec3 e1 = texelFetch(first, int(vertex)).xyz, e2 = texelFetch(second, int(vertex)).xyz;
    vec2 slope = vec2(0.0);
    vec2 last = vec2(0.0);
    float q_last = 0.0;
    uint texel = texelFetch(ring_begin, int(vertex)).x;
    for (bool more = true; more; ++texel) {
        uvec4 entries = texelFetch(rings, int(texel));
        for (uint i = 0; i < 4 && more; ++i) {
            const int other = int(entries.x & k_ring_vertex);
            const vec3 step_there = texelFetch(positions, other).xyz - here;
            const vec2 there = vec2(dot(e1, step_there), dot(e2, step_there));
            const float q = texelFetch(views, other).x;
            if ((entries.x & k_ring_fan) == 0) slope += slope_in(view.xyz, last, there, q_last, q);
            last = there;
            q_last = q;
            more = (entries.x & k_ring_last) == 0;
            entries = entries.yzwx;
        }
    }
    const float strength = view.x * parameters.feature_size * parameters.feature_size;
    const uint before = (1u << k_apparent_ridges) - 1u;
    const uint slot = bitCount(k_families & k_field_families & before);
    fields[slot * parameters.vertices + vertex] = vec4(1.0, strength, strength - parameters.high_thresholds.y, view.w);
    const vec2 direction = normalize(view.yz);
    const float growth = slope.y > 0.0 ? slope.x / slope.y : 0.0;
    const uint axis_slot = bitCount(k_families & k_axis_families & before);
    directions[axis_slot * parameters.vertices + vertex] = vec4(growth * (direction.x * e1 + direction.y * e2), 0.0);
}
