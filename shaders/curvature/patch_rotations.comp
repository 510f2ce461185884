#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Rotations of patches (exemplar::Segments::rotations_of_sequence), one per invocation, from the triangle
// of three groups of vertices. Per patch 96 bytes are read, 24 positions through caches, and 48 written.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { PatchParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer corners;  // three times k_corner_vertices a patch, four to a texel
layout(set = 0, binding = 1) uniform samplerBuffer vertices;
layout(set = 0, binding = 2, std430) writeonly buffer Rotations { vec4 rotations[]; };  // three rows a patch

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

// Along the first, in the plane of both, upright.
mat3 orthonormal_frame(vec3 first, vec3 second) {
    const vec3 x = normalize(first), z = normalize(cross(first, second));
    return mat3(x, cross(z, x), z);
}

bool is_frame(mat3 frame) {
    const float sum = dot(frame[0], frame[0]) + dot(frame[1], frame[1]) + dot(frame[2], frame[2]);
    return sum > 2.5 && sum < 3.5;  // neither of zero vectors nor of numbers that are none
}

void main() {
    const uint patch_index = linear_thread();
    if (patch_index >= parameters.patches) return;

    const uint texel = patch_index * 3 * (k_corner_vertices / 4);
    const vec3 a = corner(texel), b = corner(texel + k_corner_vertices / 4), c = corner(texel + 2 * (k_corner_vertices / 4));
    mat3 frame = orthonormal_frame(b - a, c - a);
    if (!is_frame(frame)) frame = mat3(1.0);
    const mat3 rows = transpose(frame);
    for (uint i = 0; i < 3; ++i) rotations[3 * patch_index + i] = vec4(rows[i], 0.0);
}
