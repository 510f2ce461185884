#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/ceilings.h"

// Reads a few texels again and again, to measure the rate of reads that caches hold. Each invocation begins with its own
// texel and writes the sum of all numbers that it has read.
layout(local_size_x = 256) in;
layout(push_constant) uniform Push { RoundParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer texels;
layout(set = 0, binding = 1, std430) writeonly buffer Result { uint result[]; };

void main() {
    const uint i = linear_thread();
    uvec4 sum = uvec4(0u);
    for (uint round = 0; round < parameters.rounds; ++round)
        for (uint read = 0; read < k_reads_per_round; ++read)
            sum += texelFetch(texels, int((i + round * k_reads_per_round + read) % k_texels_read));
    if (i < result.length()) result[i] = sum.x + sum.y + sum.z + sum.w;
}
