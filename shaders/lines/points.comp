#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Writes the points of chains in their order: each segment writes its first point, the last segment of a chain also
// its last point. One segment per invocation: reads 16 + 32 + 32 bytes, writes 32 to 64.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer ranks;
layout(set = 0, binding = 1) uniform usamplerBuffer point_counts;
layout(set = 0, binding = 2) uniform usamplerBuffer groups;
layout(set = 0, binding = 3) uniform usamplerBuffer segments;
layout(set = 0, binding = 4) uniform samplerBuffer picture_ends;
layout(set = 0, binding = 5, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 6, std430) writeonly buffer Points { LinePoint points[]; };
#include "shaders/lines/segments.glsl"

void main() {
    const uint index = linear_thread();
    if (index >= counts.segments) return;

    const uvec4 rank = texelFetch(ranks, int(index));
    const uint first = rank.x, on = rank.w & 1u;
    const bool closed = (rank.w & 2u) != 0u, ends = (rank.w & 4u) != 0u;
    const uint begin_of_chain = texelFetch(groups, int(first / k_count_group)).x + texelFetch(point_counts, int(first)).x;
    const uint place = begin_of_chain + rank.y;
    if (place + (ends ? 1u : 0u) >= counts.points) return;  // never, unless links contradict each other
    const LineSegmentRecord segment = segment_at(index);
    const vec4 begin = texelFetch(picture_ends, int(2u * index + 1u - on)), end = texelFetch(picture_ends, int(2u * index + on));
    const vec2 strength = on == 1u ? vec2(segment.first_strength, segment.second_strength)
                                   : vec2(segment.second_strength, segment.first_strength);
    const uint family = family_of(segment) | (closed ? k_point_closed : 0u), walked = 2u * index + 1u - on;
    const float before = uintBitsToFloat(rank.z);
    points[place] = LinePoint(begin.x, begin.y, begin.z, before, family | (rank.y == 0u ? k_point_first : 0u), first, walked,
                              strength.x);
    if (ends)
        points[place + 1u] = LinePoint(end.x, end.y, end.z, before + distance(begin.xy, end.xy), family | k_point_last, first,
                                       walked, strength.y);
}
