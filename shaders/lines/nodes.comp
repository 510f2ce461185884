#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Initializes the nodes for pointer jumping: each leads one step on. One node per invocation: reads 40 bytes and
// writes 32.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer links;  // per end
layout(set = 0, binding = 1) uniform samplerBuffer picture_ends;
layout(set = 0, binding = 2, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 3, std430) writeonly buffer Nodes { uvec4 nodes[]; };  // see jump.comp

void main() {
    const uint node = linear_thread();
    if (node >= 2u * counts.segments) return;

    const uint link = texelFetch(links, int(node)).x;
    const bool ends = link == k_no_link;
    const uint next = ends ? node : link ^ 1u;
    const int segment = int(next & ~1u);
    const float on = ends ? 0.0 : distance(texelFetch(picture_ends, segment).xy, texelFetch(picture_ends, segment + 1).xy);
    nodes[2u * node] = uvec4(next, ends ? 0u : 1u, floatBitsToUint(on), ends ? 1u : 0u);
    nodes[2u * node + 1u] = uvec4(node, 0u, 0u, 0u);
}
