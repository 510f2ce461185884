#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Computes the position of each segment in its chain, after pointer jumping: in each chain the segment with the
// smallest index is traversed from its first end to its second, and a closed chain begins with it. Counts the points
// of each chain at its first segment. One segment per invocation: reads 64 bytes, writes 16 + 4, and 4 per group.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer nodes;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2, std430) readonly buffer Counts { LineCounts counts; };
// First segment of the chain, position in it, pixels before, flags: left at its second end, closed, last segment.
layout(set = 0, binding = 3, std430) writeonly buffer Ranks { uvec4 ranks[]; };
// Number of points before the segment in its group.
layout(set = 0, binding = 4, std430) writeonly buffer Points { uint point_counts[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Groups { uint groups[]; };
#include "shaders/lib/group_sum.glsl"

uvec4 way_of(uint node) {
    return texelFetch(nodes, int(2u * node));
}
uvec4 least_of(uint node) {
    return texelFetch(nodes, int(2u * node + 1u));
}

// Returns the end at which a segment is left in the direction of its chain. first, second: least_of its two nodes.
uint way_on(uint segment, uvec4 first, uvec4 second) {
    const uint smallest = min(first.x, second.x) / 2u;
    if (smallest == segment) return 1u;
    // The node that leads to the smallest segment goes along the chain if it leaves that one at its second end.
    const bool by_first = first.x / 2u == smallest;
    const bool forward = ((by_first ? first.x : second.x) & 1u) != 0u;
    return by_first == forward ? 0u : 1u;
}

void main() {
    const uint segment = linear_thread();
    uint points = 0;
    if (segment < counts.segments) {
        const uvec4 least[2] = uvec4[](least_of(2u * segment), least_of(2u * segment + 1u));
        const uint on = way_on(segment, least[0], least[1]);
        const uvec4 back = way_of(2u * segment + 1u - on), back_least = least[1u - on];
        const bool closed = back.w == 0u;
        const uint first = closed ? back_least.x / 2u : back.x / 2u;
        const uint rank = closed ? back_least.y : back.y;
        const uint length_before = closed ? back_least.z : back.z;
        const bool starts = segment == first;
        uint steps = way_of(2u * segment + on).y;  // to the end of an open chain
        // The first end of the first segment of a closed chain is joined with the last segment.
        if (closed && starts) steps = least_of(texelFetch(links, int(2u * segment)).x ^ 1u).y;
        if (starts) points = steps + 2u;
        const bool ends = closed ? (texelFetch(links, int(2u * segment + on)).x / 2u == first) : steps == 0u;
        ranks[segment] = uvec4(first, rank, length_before, on | (closed ? 2u : 0u) | (ends ? 4u : 0u));
    }
    const uint before = exclusive_sum(points);
    if (segment >= counts.segments) return;
    point_counts[segment] = before;
    if (gl_LocalInvocationID.x == 0u) groups[segment / k_count_group] = group_total;
}
