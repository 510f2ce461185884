#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/curvature.h"
#include "shaders/lib/row_lanes.glsl"

// Computes the inputs of learned curvature from the local shape of patches (exemplar::LocalShapeState::read),
// each a row of weights times normals and heights of its patch. Reads 16 bytes and 8 per vertex of the patch; normals
// and positions come from caches, which the inputs of a patch share. Writes 4.
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
    for (uint i = first_item(); i < count; i += k_row_lanes)
        sum += texelFetch(vertices, int(texelFetch(members, int(first + i)).x)).xyz;
    return row_total(vec4(sum, 0.0)).xyz / float(max(count, 1u));
}

float weighted(uvec2 weights, vec3 normal, float height) {
    return dot(vec4(unpackHalf2x16(weights.x), unpackHalf2x16(weights.y)), vec4(normal, height));
}

void main() {
    const uint input_row = row_index();
    if (input_row >= parameters.inputs) return;

    const uvec4 entry = texelFetch(table, int(input_row));
    const vec3 middle = center(entry.y, entry.z);
    const int row = int(3 * entry.x);
    // The inverse rotation, to the frame of the patch: its columns are the rows of the rotation.
    const mat3 turn = mat3(texelFetch(rotations, row).xyz, texelFetch(rotations, row + 1).xyz, texelFetch(rotations, row + 2).xyz);
    const vec3 up = parameters.inverse_unit * vec3(turn[0].z, turn[1].z, turn[2].z);
    float sum = 0.0;
    for (uint i = 2 * first_item(); i < entry.z; i += 2 * k_row_lanes) {
        const uvec4 words = texelFetch(weights, int(entry.w + i / 2));
        const uint last = entry.z - 1;  // padding of an odd number, with weight zero
        const int a = int(texelFetch(members, int(entry.y + i)).x), b = int(texelFetch(members, int(entry.y + min(i + 1, last))).x);
        sum += weighted(words.xy, turn * texelFetch(normals, a).xyz, dot(up, texelFetch(vertices, a).xyz - middle)) +
               weighted(words.zw, turn * texelFetch(normals, b).xyz, dot(up, texelFetch(vertices, b).xyz - middle));
    }
    sum = row_total(vec4(sum)).x;
    if (first_item() == 0) inputs[input_row] = texelFetch(biases, int(input_row)).x + sum;
}
