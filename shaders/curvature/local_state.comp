#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Computes the inputs of learned curvature from the local shape of patches (exemplar::LocalShapeState::read), one
// per invocation. Reads 16 bytes and 8 per vertex of its patch; normals and positions come from caches, which the
// inputs of a patch share. Writes 4.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { LocalInputParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer table;    // LocalInput
layout(set = 0, binding = 1) uniform usamplerBuffer members;  // vertices of patches
layout(set = 0, binding = 2) uniform usamplerBuffer weights;
layout(set = 0, binding = 3) uniform samplerBuffer biases;     // minus mapped mean shape, minus mean input
layout(set = 0, binding = 4) uniform samplerBuffer rotations;  // three rows per patch
layout(set = 0, binding = 5) uniform samplerBuffer vertices;
layout(set = 0, binding = 6) uniform samplerBuffer normals;
layout(set = 0, binding = 7, std430) writeonly buffer Inputs { float inputs[]; };

vec3 center(uint first, uint count) {
    vec3 sum = vec3(0.0);
    for (uint i = 0; i < count; ++i) sum += texelFetch(vertices, int(texelFetch(members, int(first + i)).x)).xyz;
    return sum / float(max(count, 1u));
}

float weighted(uvec2 weights, vec3 normal, float height) {
    return dot(vec4(unpackHalf2x16(weights.x), unpackHalf2x16(weights.y)), vec4(normal, height));
}

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.inputs) return;

    const uvec4 entry = texelFetch(table, int(thread));
    const vec3 middle = center(entry.y, entry.z);
    const int row = int(3 * entry.x);
    // The inverse rotation, to the frame of the patch: its columns are the rows of the rotation.
    const mat3 turn = mat3(texelFetch(rotations, row).xyz, texelFetch(rotations, row + 1).xyz, texelFetch(rotations, row + 2).xyz);
    const vec3 up = parameters.inverse_unit * vec3(turn[0].z, turn[1].z, turn[2].z);
    float sum = texelFetch(biases, int(thread)).x;
    for (uint i = 0; i < entry.z; i += 2) {
        const uvec4 words = texelFetch(weights, int(entry.w + i / 2));
        const uint last = entry.z - 1;  // padding of an odd number, with weight zero
        const int a = int(texelFetch(members, int(entry.y + i)).x), b = int(texelFetch(members, int(entry.y + min(i + 1, last))).x);
        sum += weighted(words.xy, turn * texelFetch(normals, a).xyz, dot(up, texelFetch(vertices, a).xyz - middle)) +
               weighted(words.zw, turn * texelFetch(normals, b).xyz, dot(up, texelFetch(vertices, b).xyz - middle));
    }
    inputs[thread] = sum;
}
