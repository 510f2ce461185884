#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// A round of pointer jumping: makes the reach of each node along its chain four times as long. A node has two texels:
// 1. the node it leads to, the steps to it, the pixels of the segments after its own up to and including that one's,
//    and whether the chain ends there;
// 2. of the nodes before that one, the one of the smallest segment, with steps and pixels to it.
// One node per invocation: reads 128 bytes and writes 32.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer source;
layout(set = 0, binding = 1, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 2, std430) writeonly buffer Target { uvec4 target[]; };

float added(uint a, uint b) {
    return uintBitsToFloat(a) + uintBitsToFloat(b);
}

void main() {
    const uint node = linear_thread();
    if (node >= 2u * counts.segments) return;

    uvec4 way = texelFetch(source, int(2u * node)), least = texelFetch(source, int(2u * node + 1u));
    for (uint jump = 0; jump < 3; ++jump) {
        const uvec4 next = texelFetch(source, int(2u * way.x)), next_least = texelFetch(source, int(2u * way.x + 1u));
        if (next_least.x / 2u < least.x / 2u)
            least = uvec4(next_least.x, way.y + next_least.y, floatBitsToUint(added(way.z, next_least.z)), 0u);
        way = uvec4(next.x, way.y + next.y, floatBitsToUint(added(way.z, next.z)), next.w);
    }
    target[2u * node] = way;
    target[2u * node + 1u] = least;
}
