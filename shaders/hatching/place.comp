#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching.h"

// Appends the strokes that won their round to those placed, and records them in the clearance map
// (host/hatching/placement/clearance.cpp). One or more workgroups per stroke: writes 8 bytes per point, and up to 4
// for each of the pixels within one and a quarter spacings. The smallest word stays, so the order of writes does not
// matter.
layout(local_size_x = k_hatch_group) in;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer grid;
layout(set = 0, binding = 1, std430) readonly buffer Ways { ivec2 ways[]; };
layout(set = 0, binding = 2, std430) readonly buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 3, std430) writeonly buffer StrokePoints { ivec2 stroke_points[]; };
layout(set = 0, binding = 4, std430) buffer Near { uint near[]; };
#include "shaders/hatching/candidate.glsl"

void note(ivec2 point, int reach, uint first) {
    const int most = (reach >> parameters.near_shift) * (reach >> parameters.near_shift);
    ivec2 low, high;
    pixels_within(point, reach, low, high);
    for (int y = low.y + candidate_part(); y <= high.y; y += candidate_parts())
        for (int x = low.x; x <= high.x; ++x) {
            const ivec2 way = offset_from_center(ivec2(x, y), point);
            const int squared = dot_of(way, way);
            if (squared > most) continue;
            const uint word = floor_sqrt(uint(squared)) << 22 | uint(way.x + 1024) << 11 | uint(way.y + 1024);
            atomicMin(near[first + uint(index_of(ivec2(x, y)))], word);
        }
}

void main() {
    const uint place = candidate_place();
    const TrialRecord trial = trials[place];
    if ((trial.state & k_lost_trial) != 0u) return;

    const uint first = (trial.state >> k_layer_shift) * parameters.width * parameters.height;
    for (uint i = gl_LocalInvocationID.x; i < trial.count; i += k_hatch_group) {
        const ivec2 point = way_point(place, trial.way_begin, trial.begin + i);
        stroke_points[trial.target + i] = point;
        const int spacing = spacing_of(texel_of(point));
        if (is_recorded(i, trial.count, spacing)) note(point, clearance_radius(spacing), first);
    }
}
