#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/coherence.h"

// Computes the texture phase at each point of a chain: mostly from the votes around it, to a small part from those
// of the whole chain, so that changes of length even out in time (host/lines/strokes/coherence.cpp). One point per
// invocation: reads the votes of its chain and, from caches, 16 bytes of each point around it; writes 8.
layout(local_size_x = k_count_group) in;
layout(push_constant) uniform Push { FollowParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer points;  // LinePoint, two texels each
layout(set = 0, binding = 1) uniform usamplerBuffer matches;  // votes.comp, two texels each
layout(set = 0, binding = 2, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 3, std430) readonly buffer Votes { ChainVotes votes[]; };
// Direction (+1 or -1) and offset in pixels, see texture_phase.glsl.
layout(set = 0, binding = 4, std430) writeonly buffer Phases { vec2 phases[]; };

const float k_pi = 3.14159265358979;

// Sums the votes of a chain's pieces to one side of a point; nearer ones weigh more.
vec2 votes_beside(int point, int step, float here, uint chain_and_way) {
    vec2 sum = vec2(0.0);
    for (int i = 0; i < k_follow_points; ++i) {
        const int at = point + step * i;
        if (at < 0 || at >= int(counts.points)) break;
        const uvec4 texel = texelFetch(matches, 2 * at + 1);
        const vec3 vote = uintBitsToFloat(texel.xyz);
        const float near = 1.0 - abs(vote.z - here) / float(k_follow_reach);
        if ((texel.w ^ chain_and_way) > 1u || !(near > 0.0)) break;
        if (texel.w == chain_and_way) sum += near * vote.xy;
    }
    return sum;
}

vec2 unit(vec2 v) {
    const float size = length(v);
    return size > 0.0 ? v / size : vec2(0.0);
}

void main() {
    const uint index = linear_thread();
    if (index >= counts.points) return;

    const float here = uintBitsToFloat(texelFetch(points, int(2u * index)).w);
    const float period = uintBitsToFloat(texelFetch(matches, int(2u * index)).z);
    const uint chain = texelFetch(points, int(2u * index + 1u)).y;
    const ChainVotes v = votes[chain];
    const bool along = v.balance >= 0;
    const vec2 of_all = unit(along ? vec2(v.along_cos, v.along_sin) : vec2(v.against_cos, v.against_sin));
    vec2 phase = vec2(1.0, 0.0);
    if (parameters.keeps != 0u && of_all != vec2(0.0)) {
        const uint ours = 2u * chain + (along ? 0u : 1u);
        const vec2 around = unit(votes_beside(int(index), 1, here, ours) + votes_beside(int(index) - 1, -1, here, ours));
        const vec2 turn = around == vec2(0.0) ? of_all : mix(around, of_all, 1.0 / float(k_whole_chain_divisor));
        phase = vec2(along ? 1.0 : -1.0, period * fract(atan(turn.y, turn.x) / (2.0 * k_pi)));
    }
    phases[index] = phase;
}
