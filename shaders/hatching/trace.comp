#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching.h"

// Traces the strokes of a round from their seeds (host/hatching/placement/stroke_tracing.cpp). One stroke per
// invocation: reads some twenty texels per pixel of its streamline, and writes 8 bytes.
layout(local_size_x = k_hatch_group) in;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer grid;
layout(set = 0, binding = 1) uniform usamplerBuffer near;
layout(set = 0, binding = 2, std430) buffer Lists { SeedQueueRecord lists[]; };
layout(set = 0, binding = 3, std430) buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 4, std430) buffer Ways { ivec2 ways[]; };
layout(set = 0, binding = 5, std430) buffer Counts { PlacementCounts counts; };
#include "shaders/hatching/stroke_tracing.glsl"

// Returns the claim of the trial at place i of the round's list (StrokeClaims::claim_of).
uint claim_of(uint i, uint shortness) {
    const uint mask = (1u << 18) - 1u, mixed = i * 0x2c1b5u & mask;
    const uint chance = (mixed ^ mixed >> 9) * 0x297a9u & mask;
    return (parameters.rounds_left << 2 | shortness) << 18 | chance;
}

// Returns how many workgroups share the pixels around a streamline, so that each stays far below the limit of D1 in
// docs/portability.md.
uint parts_of(uint begin, uint count) {
    const uint k_max_rounds = 16384u;
    int spacing = 0;
    for (uint k = 0u; k < count; ++k)
        spacing = max(spacing, spacing_of(texel_of(ways[way_first + (begin + k) % parameters.room])));
    const uint passes = 1u + count / k_hatch_group, side = uint((5 * spacing >> (k_spacing_bits + 1)) + 4);
    return 1u + passes * side * side / k_max_rounds;
}

void put_trial(uint i, ivec2 part) {
    const uint begin = ring_index(-back_reach()) - way_first;
    trials[i].state |= k_open_trial;
    trials[i].claim = claim_of(i, shortness(part.y - part.x));
    trials[i].way_begin = begin;
    trials[i].way_count = uint(last_place() + 1);
    trials[i].begin = uint(part.x);
    trials[i].count = uint(part.y - part.x + 1);
    trials[atomicAdd(counts.candidate_groups[0], 1u)].listed = i;
    atomicMax(counts.candidate_groups[1], parts_of(begin, trials[i].way_count));
}

void main() {
    const uint i = linear_thread();
    if (i >= counts.trials || (trials[i].state & k_seeded_trial) == 0u) return;

    const ivec2 seed = ivec2(trials[i].seed_x, trials[i].seed_y), heading = ivec2(trials[i].heading_x, trials[i].heading_y);
    ivec2 part;
    if (trace(i * parameters.room, trials[i].state >> k_layer_shift, seed, heading, part))
        put_trial(i, part);
    else
        ++lists[counts.in_blocks != 0u ? i : parameters.blocks + i].next;
}
