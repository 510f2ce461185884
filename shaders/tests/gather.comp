#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"

// Computes sums[i], the sum of the four components of vectors[indices[i]].
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) uniform usamplerBuffer indices;
layout(set = 0, binding = 1) uniform samplerBuffer vectors;
layout(set = 0, binding = 2, std430) writeonly buffer Sums { float sums[]; };

void main() {
    const uint i = linear_thread();
    if (i < sums.length()) sums[i] = dot(texelFetch(vectors, int(texelFetch(indices, int(i)).x)), vec4(1.0));
}
