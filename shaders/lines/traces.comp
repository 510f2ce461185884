#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/coherence.h"

// Projects the lines of the previous frame, moved along with the surface, into this picture. Clears the votes. One
// segment of either frame per invocation: reads 32 + 16 bytes and the corners of its face, writes 32 + 20.
layout(local_size_x = k_count_group) in;
layout(push_constant) uniform Push { FollowParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;
layout(set = 0, binding = 1) uniform usamplerBuffer faces;
layout(set = 0, binding = 2) uniform usamplerBuffer segments;  // of the previous frame
layout(set = 0, binding = 3) uniform samplerBuffer traces;
layout(set = 0, binding = 4, std430) readonly buffer Counts { LineCounts counts; };
// Two per segment: pixels, texture coordinate, share drawn or -1 if it reaches behind the eye.
layout(set = 0, binding = 5, std430) writeonly buffer Ends { vec4 ends[]; };
layout(set = 0, binding = 6, std430) writeonly buffer Votes { ChainVotes votes[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Flicker { FlickerSums flicker; };
#include "shaders/lines/in_picture.glsl"
#include "shaders/lines/segments.glsl"

void main() {
    const uint index = linear_thread();
    if (index == 0u) flicker = FlickerSums(0u, 0u, 0u, 0u, 0u);
    if (index < counts.segments) votes[index] = ChainVotes(0, 0, 0, 0, 0);
    if (index >= counts.previous_segments) return;

    const LineSegmentRecord segment = segment_at(index);
    const uvec3 corners = texelFetch(faces, int(segment.face)).xyz;
    const mat3 points = mat3(texelFetch(positions, int(corners.x)).xyz, texelFetch(positions, int(corners.y)).xyz,
                             texelFetch(positions, int(corners.z)).xyz);
    const vec4 trace = texelFetch(traces, int(index));
    for (uint end = 0; end < 2; ++end) {
        const vec4 at = in_picture(points * end_of(segment, end));
        ends[2u * index + end] = vec4(at.xy, end == 0u ? trace.x : trace.y, at.w > 0.0 ? trace.z : -1.0);
    }
}
