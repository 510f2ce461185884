#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Computes the rotations of patches (exemplar::Segments::rotations_of_sequence), one per invocation, from the
// triangle of three groups of vertices. Per patch 96 bytes are read, 24 positions through caches, and 48 written.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { PatchParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer corners;  // 3 x k_corner_vertices per patch, four per texel
layout(set = 0, binding = 1) uniform samplerBuffer vertices;
layout(set = 0, binding = 2, std430) writeonly buffer Rotations { vec4 rotations[]; };  // three rows per patch

vec3 position(uint vertex) {
    return texelFetch(vertices, int(vertex)).xyz;
}

vec3 corner(uint first_texel) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < k_corner_vertices / 4; ++i) {
        const uvec4 four = texelFetch(corners, int(first_texel + i));
        sum += position(four.x) + position(four.y) + position(four.z) + position(four.w);
    }
    return sum;
}

// Returns the frame with x along the first edge and z perpendicular to both, or the identity if they are on a line.
mat3 triangle_frame(vec3 first, vec3 second) {
    const float k_min_width = 1e-4;  // as in host/curvature/state/segments.cpp
    const vec3 up = cross(first, second), x = normalize(first), z = normalize(up);
    const float longest = max(dot(first, first), dot(second, second));
    return length(up) > k_min_width * longest ? mat3(x, cross(z, x), z) : mat3(1.0);
}

void main() {
    const uint patch_index = linear_thread();
    if (patch_index >= parameters.patches) return;

    const uint texel = patch_index * 3 * (k_corner_vertices / 4);
    const vec3 a = corner(texel), b = corner(texel + k_corner_vertices / 4), c = corner(texel + 2 * (k_corner_vertices / 4));
    const mat3 rows = transpose(triangle_frame(b - a, c - a));
    for (uint i = 0; i < 3; ++i) rotations[3 * patch_index + i] = vec4(rows[i], 0.0);
}
