#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching.h"

// Finds the next place of each seed list at which a stroke may begin (host/hatching/placement/stroke_front.cpp). One
// list per invocation: reads some 15 texels per place.
layout(local_size_x = k_hatch_group) in;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer grid;
layout(set = 0, binding = 1) uniform usamplerBuffer near;
layout(set = 0, binding = 2) uniform usamplerBuffer stroke_points;
layout(set = 0, binding = 3, std430) buffer Lists { SeedQueueRecord lists[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 5, std430) readonly buffer Counts { PlacementCounts counts; };
#include "shaders/hatching/stroke_seeds.glsl"

void main() {
    const uint i = linear_thread();
    if (i >= counts.trials) return;

    const uint index = counts.in_blocks != 0u ? i : parameters.blocks + i;
    const SeedQueueRecord list = lists[index];
    const uint count = seed_count(list), end = min(count, list.next + k_max_seeds_per_round);
    uint next = list.next;
    bool found = false;
    ivec2 point = ivec2(0), heading = ivec2(0);
    while (!found && next < end) {
        found = seed_at(list, next, point, heading);
        if (!found) ++next;
    }
    lists[index].next = next;
    trials[i].seed_x = point.x;
    trials[i].seed_y = point.y;
    trials[i].heading_x = heading.x;
    trials[i].heading_y = heading.y;
    trials[i].state = (next < count ? k_pending_trial : 0u) | (found ? k_seeded_trial : 0u) |
                      (list.kind >> k_layer_shift) << k_layer_shift;
}
