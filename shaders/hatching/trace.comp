#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching.h"

// Tries the places of seed lists, each from where it was left, up to the first that gives a stroke (host/hatching/
// streamlines.cpp). One list per invocation: reads some twenty texels per pixel of way, and writes 8 bytes.
layout(local_size_x = k_hatch_group) in;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer grid;
layout(set = 0, binding = 1) uniform usamplerBuffer near;
layout(set = 0, binding = 2) uniform usamplerBuffer stroke_points;
layout(set = 0, binding = 3, std430) buffer Lists { SeedListRecord lists[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 5, std430) buffer Ways { ivec2 ways[]; };
layout(set = 0, binding = 6, std430) buffer Counts { PlacementCounts counts; };
#include "shaders/lib/stroke_seeds.glsl"
#include "shaders/lib/stroke_tracing.glsl"

// What place i of the round's list claims pixels with (StrokeClaims::claim_of).
uint claim_of(uint i, uint shortness) {
    const uint mask = (1u << 18) - 1u, mixed = i * 0x2c1b5u & mask;
    const uint chance = (mixed ^ mixed >> 9) * 0x297a9u & mask;
    return (parameters.rounds_left << 2 | shortness) << 18 | chance;
}

void put_trial(uint i, Way way, ivec2 part) {
    trials[i].claim = claim_of(i, shortness(way, part.y - part.x));
    trials[i].way_begin = way.back.reach == 0 ? 0u : parameters.room - uint(way.back.reach);
    trials[i].way_count = uint(last_of(way) + 1);
    trials[i].begin = uint(part.x);
    trials[i].count = uint(part.y - part.x + 1);
    trials[atomicAdd(counts.candidate_groups[0], parameters.parts) / parameters.parts].listed = i;
}

void main() {
    const uint i = linear_thread();
    if (i >= counts.trials) return;

    const uint index = counts.in_blocks != 0u ? i : parameters.blocks + i;
    SeedListRecord list = lists[index];
    const uint count = seed_count(list), layer = list.kind >> k_layer_shift;
    bool open = false;
    ivec2 part = ivec2(0);
    Way way;
    int work = 0;
    while (!open && list.next < count && work < k_most_round_work) {
        ivec2 point = ivec2(0), heading = ivec2(0);
        bool found = false;
        while (!found && list.next < count && work < k_most_round_work) {
            ++work;
            found = seed_at(list, list.next, point, heading);
            if (!found) ++list.next;
        }
        when (found) {
            const Branch on = Branch(point, heading, 1, 0, 0, 0, 0, k_no_end);
            const Branch back = Branch(point, -heading, -1, 0, 0, 0, 0, k_no_end);
            way = Way(i * parameters.room, layer, point, texel_of(point), 0, ivec2(0), work, on, back);
            open = trace(way, part);
            work = way.work;
            if (!open) ++list.next;
        }
    }
    const uint state = open ? k_open_trial : list.next < count ? k_pending_trial : 0u;
    lists[index].next = list.next;
    trials[i].state = state | layer << k_layer_shift;
    if (open) put_trial(i, way, part);
}
