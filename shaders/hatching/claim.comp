#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching.h"

// Claims pixels for the strokes tried in a round; a second dispatch, after all claims, finds the strokes that lost
// one of their pixels to a smaller claim (host/hatching/placement/stroke_claims.cpp). One or more workgroups per
// stroke: some 40 pixels per point of its streamline, 4 bytes each. The order of claims does not change the result.
layout(local_size_x = k_hatch_group) in;
layout(constant_id = 0) const bool k_checks_claims = false;
layout(push_constant) uniform Push { PlacementParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer grid;
layout(set = 0, binding = 1, std430) readonly buffer Ways { ivec2 ways[]; };
layout(set = 0, binding = 2, std430) buffer Trials { TrialRecord trials[]; };
layout(set = 0, binding = 3, std430) buffer Claims { uint claims[]; };
#include "shaders/hatching/candidate.glsl"

const int k_half_diagonal = 2897;  // of a pixel, rounded up

// Claims the pixels around a point or, with k_checks_claims, returns whether another stroke has one of them.
bool visit_pixels(ivec2 point, int reach, uint first, uint claim) {
    const int most = (reach >> parameters.near_shift) * (reach >> parameters.near_shift);
    ivec2 low, high;
    pixels_within(point, reach, low, high);
    bool lost = false;
    for (int y = low.y + candidate_part(); y <= high.y; y += candidate_parts())
        for (int x = low.x; x <= high.x; ++x) {
            const ivec2 way = offset_from_center(ivec2(x, y), point);
            if (dot_of(way, way) > most) continue;
            const uint pixel = first + uint(index_of(ivec2(x, y)));
            if (k_checks_claims)
                lost = lost || claims[pixel] != claim;
            else
                atomicMin(claims[pixel], claim);
        }
    return lost;
}

void main() {
    const uint place = candidate_place();
    const TrialRecord trial = trials[place];
    const uint first = (trial.state >> k_layer_shift) * parameters.width * parameters.height;
    bool lost = false;
    for (uint i = gl_LocalInvocationID.x; i < trial.way_count; i += k_hatch_group) {
        const ivec2 point = way_point(place, trial.way_begin, i);
        const int spacing = spacing_of(texel_of(point));
        if (!is_recorded(i, trial.way_count, spacing)) continue;
        const int reach = share_of_spacing(spacing, parameters.test_share) / 2 + k_half_diagonal;
        if (visit_pixels(point, reach, first, trial.claim)) lost = true;
    }
    if (lost) atomicOr(trials[place].state, k_lost_trial);
}
