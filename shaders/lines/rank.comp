#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Which segment of its chain each is, once nodes see all of it: in each chain the segment of the smallest number runs from
// its first end to its second, and a closed one begins with it. Counts the points of each chain at its first segment. One
// segment per invocation: reads 64 bytes, writes 16 + 4, and 4 a group.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer nodes;
layout(set = 0, binding = 1) uniform usamplerBuffer links;
layout(set = 0, binding = 2, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 3, std430) writeonly buffer Ranks { uvec4 ranks[]; };  // first segment, rank, pixels before, flags
layout(set = 0, binding = 4, std430) writeonly buffer Points { uint point_counts[]; };  // before it in its group
layout(set = 0, binding = 5, std430) writeonly buffer Groups { uint groups[]; };
#include "shaders/lib/group_sum.glsl"

uvec4 way_of(uint node) {
    return texelFetch(nodes, int(2u * node));
}
uvec4 least_of(uint node) {
    return texelFetch(nodes, int(2u * node + 1u));
}

// The end by which a segment is left on the way on along its chain.
uint way_on(uint segment, uvec4 first, uvec4 second) {
    const uint smallest = min(first.x, second.x) / 2u;
    if (smallest == segment) return 1u;
    // Left by this end one comes to the smallest, which is left by its second end if this is the way on.
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
        // The last of a closed chain is before the first, whose first end leads there.
        if (closed && starts) steps = least_of(texelFetch(links, int(2u * segment)).x ^ 1u).y;
        if (starts) points = steps + 2u;
        const bool ends = closed ? (texelFetch(links, int(2u * segment + on)).x / 2u == first) : steps == 0u;
        ranks[segment] = uvec4(first, rank, length_before, on | (closed ? 2u : 0u) | (ends ? 4u : 0u));
    }
    const uint before = sum_before(points);
    if (segment >= counts.segments) return;
    point_counts[segment] = before;
    if (gl_LocalInvocationID.x == 0u) groups[segment / k_count_group] = group_total;
}
