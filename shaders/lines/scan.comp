#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/lines.h"

// Replaces the sums of groups by their exclusive prefix sums, and writes the total and the arguments of the
// following indirect commands. A single workgroup: 4 bytes are read and 4 written per group.
layout(local_size_x = 128) in;
layout(constant_id = 0) const bool k_of_points = false;  // else of segments
layout(push_constant) uniform Push { ScanParameters parameters; };
layout(set = 0, binding = 0, std430) buffer Groups { uint groups[]; };
layout(set = 0, binding = 1, std430) buffer Counts { LineCounts counts; };

#include "shaders/lib/group_sum.glsl"

uint groups_of(uint items) {
    return (items + k_count_group - 1u) / k_count_group;
}

// The counts of workgroups for items, folded as linear_group() expects it: devices allow 65,535 along an axis.
uint[3] folded_groups(uint items) {
    const uint groups = groups_of(items), rows = max((groups + 0xfffeu) / 0xffffu, 1u);
    return uint[3]((groups + rows - 1u) / rows, rows, 1u);
}

void put_segments(uint total) {
    const uint segments = min(total, parameters.most), previous = counts.segments;
    counts.previous_segments = previous;
    counts.segments = segments;
    counts.dropped_segments = total - segments;
    counts.segment_groups = folded_groups(segments);
    counts.trace_groups = folded_groups(max(segments, previous));
    counts.node_groups = folded_groups(2u * segments);
    // Enough rounds for the longest possible chain. Their number is even, so that the result is in the first buffer.
    uint rounds = segments > 1u ? uint(findMSB(segments - 1u)) / 2u + 1u : 0u;
    rounds += rounds & 1u;
    for (uint i = 0; i < k_line_rounds; ++i) {
        const uint groups[3] = folded_groups(i < rounds ? 2u * segments : 0u);
        for (uint axis = 0; axis < 3; ++axis) counts.round_groups[3u * i + axis] = groups[axis];
    }
}

void put_points(uint total) {
    counts.points = total;
    counts.point_groups = folded_groups(total);
    counts.draw[0] = 6u * total;
    counts.draw[1] = 1u;
    counts.draw[2] = counts.draw[3] = 0u;
}

void main() {
    const uint count = k_of_points ? groups_of(counts.segments) : parameters.groups;
    const uint share = (count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
    const uint begin = min(gl_LocalInvocationID.x * share, count), end = min(begin + share, count);
    uint sum = 0;
    for (uint i = begin; i < end; ++i) sum += groups[i];
    uint before = exclusive_sum(sum);
    for (uint i = begin; i < end; ++i) {
        const uint own = groups[i];
        groups[i] = before;
        before += own;
    }
    if (gl_LocalInvocationID.x != 0u) return;
    if (k_of_points)
        put_points(group_total);
    else
        put_segments(group_total);
}
