#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching.h"

// Finds the next place of each seed list at which a stroke may begin (host/hatching/placement/stroke_front.cpp). One
// list per invocation; on cards one per workgroup, whose invocations try as many places at a time. Reads some 15 texels
// per place.
layout(local_size_x = k_hatch_group) in;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer grid;
layout(set = 0, binding = 1) uniform usamplerBuffer near;
layout(set = 0, binding = 2) uniform usamplerBuffer stroke_points;
layout(set = 0, binding = 3, std430) buffer Lists { SeedQueueRecord lists[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 5, std430) readonly buffer Counts { PlacementCounts counts; };
#include "shaders/hatching/stroke_seeds.glsl"

uint list_index(uint trial) {
    return counts.in_blocks != 0u ? trial : parameters.blocks + trial;
}

// Stores the next place of a list of `count` places, and the seed there if there is one.
void store(uint trial, SeedQueueRecord list, uint next, uint count, bool found, ivec2 point, ivec2 heading) {
    lists[list_index(trial)].next = next;
    trials[trial].seed_x = point.x;
    trials[trial].seed_y = point.y;
    trials[trial].heading_x = heading.x;
    trials[trial].heading_y = heading.y;
    trials[trial].state = (next < count ? k_pending_trial : 0u) | (found ? k_seeded_trial : 0u) |
                          (list.kind >> k_layer_shift) << k_layer_shift;
}

#ifdef EXEMPLAR_CPU
void main() {
    const uint trial = linear_thread();
    if (trial >= counts.trials) return;

    const SeedQueueRecord list = lists[list_index(trial)];
    const uint count = seed_count(list), end = min(count, list.next + k_max_seeds_per_round);
    uint next = list.next;
    bool found = false;
    ivec2 point = ivec2(0), heading = ivec2(0);
    while (!found && next < end) {
        found = seed_at(list, next, point, heading);
        if (!found) ++next;
    }
    store(trial, list, next, count, found, point, heading);
}
#else
shared uint first_found;

void main() {
    const uint trial = linear_group(), own = gl_LocalInvocationID.x;
    if (trial >= counts.trials) return;

    const SeedQueueRecord list = lists[list_index(trial)];
    const uint count = seed_count(list), end = min(count, list.next + k_max_seeds_per_round), nowhere = max(end, list.next);
    if (own == 0u) first_found = nowhere;
    barrier();
    uint place = list.next + own;
    ivec2 point = ivec2(0), heading = ivec2(0);
    for (uint begin = list.next; begin < end; begin += k_hatch_group) {
        place = begin + own;
        if (place < end && seed_at(list, place, point, heading)) atomicMin(first_found, place);
        barrier();
        if (first_found != nowhere) break;
        barrier();
    }
    const bool found = first_found != nowhere;
    if (found ? place == first_found : own == 0u) store(trial, list, first_found, count, found, point, heading);
}
#endif
