#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lines/texture_phase.glsl"
#include "shaders/shared/coherence.h"

// Writes the traces of the segments for the next frame, and sums up the flicker of lines. One point per invocation:
// reads 128 bytes, writes 16, and adds 20 per group.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer points;   // LinePoint, two texels each
layout(set = 0, binding = 1) uniform usamplerBuffer visible;  // two words per point
layout(set = 0, binding = 2) uniform samplerBuffer strokes;   // two texels per point
layout(set = 0, binding = 3) uniform usamplerBuffer matches;  // votes.comp, two texels each
layout(set = 0, binding = 4) uniform samplerBuffer phases;    // two texels per point
layout(set = 0, binding = 5, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 6, std430) writeonly buffer Traces { vec4 traces[]; };  // per segment
layout(set = 0, binding = 7, std430) buffer Flicker { FlickerSums flicker; };

struct Flickering {
    vec4 lengths;  // drawn, kept, appeared, slip
    float stretch;
};
shared Flickering group_sums[gl_WorkGroupSize.x];
const Flickering k_invalid_index = Flickering(vec4(0.0), 0.0);

vec2 phase_of(uint point) {
    return vec2(texelFetch(phases, int(2u * point)).x, texelFetch(phases, int(2u * point + 1u)).x);
}

// Writes the trace of the segment to the next point; returns its contribution to the sums.
Flickering trace_and_flicker(uint index) {
    const uvec4 more = texelFetch(points, int(2u * index + 1u));
    const uint kind = more.x, walked = more.z;
    if ((kind & k_point_last) != 0u) return k_invalid_index;
    const vec3 match = uintBitsToFloat(texelFetch(matches, int(2u * index)).xyz);
    const float period = match.z, along = uintBitsToFloat(texelFetch(points, int(2u * index)).w),
                along_next = uintBitsToFloat(texelFetch(points, int(2u * index + 2u)).w), size = along_next - along;
    const vec2 ends = texture_ends(phase_of(index), phase_of(index + 1u), along, along_next, period);
    const uint mask = texelFetch(visible, int(2u * index)).x, samples = texelFetch(visible, int(2u * index + 1u)).x;
    const float share = float(bitCount(mask)) / float(samples) * texelFetch(strokes, int(2u * index)).w;
    traces[walked / 2u] = vec4((walked & 1u) == 0u ? ends : ends.yx, share, 0.0);
    if (share == 0.0 || !(size < 1e6)) return k_invalid_index;
    const float before = max(match.y, 0.0), turns = fract((0.5 * (ends.x + ends.y) - match.x) / period);
    const float kept = size * min(share, before);
    return Flickering(vec4(size * share, kept, size * max(share - before, 0.0), kept * period * min(turns, 1.0 - turns)),
                      share * abs(abs(ends.y - ends.x) - size));
}

void main() {
    const uint index = linear_thread(), self = gl_LocalInvocationID.x;
    group_sums[self] = k_invalid_index;
    if (index < counts.points) group_sums[self] = trace_and_flicker(index);
    barrier();
    if (self != 0u) return;
    Flickering sum = k_invalid_index;
    for (uint i = 0; i < gl_WorkGroupSize.x; ++i) {
        sum.lengths += group_sums[i].lengths;
        sum.stretch += group_sums[i].stretch;
    }
    const uvec4 units = uvec4(round(k_flicker_unit * sum.lengths));
    atomicAdd(flicker.drawn, units.x);
    atomicAdd(flicker.kept, units.y);
    atomicAdd(flicker.appeared, units.z);
    atomicAdd(flicker.slip, units.w);
    atomicAdd(flicker.stretch, uint(round(k_flicker_unit * sum.stretch)));
}
