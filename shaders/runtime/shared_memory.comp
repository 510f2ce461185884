#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/ceilings.h"

// Reads a tile of shared memory again and again, to measure the rate of such reads. Each invocation begins with its own
// vector and writes the sum of all numbers that it has read.
layout(local_size_x = 256) in;
layout(push_constant) uniform Push { RoundParameters parameters; };
layout(set = 0, binding = 0, std430) writeonly buffer Result { uint result[]; };

shared uvec4 tile[k_shared_vectors];

void main() {
    const uint i = linear_thread();
    const uint own = gl_LocalInvocationIndex;
    tile[own] = uvec4(own, own + 1u, own + 2u, own + 3u);
    barrier();
    uvec4 sum = uvec4(0u);
    for (uint round = 0; round < parameters.rounds; ++round)
        for (uint read = 0; read < k_reads_per_round; ++read)
            sum += tile[(own + round * k_reads_per_round + read) % k_shared_vectors];
    if (i < result.length()) result[i] = sum.x + sum.y + sum.z + sum.w;
}
