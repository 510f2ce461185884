#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/loops.glsl"
#include "shaders/labeling/context_layout.glsl"
#include "shaders/shared/context.h"

// Contextual histograms over the distance along an axis (thesis Eq. A.1): one face (x) and one axis (y) of one part (z)
// per invocation. The samples are sorted along the axis. Those between two distances form two runs, found by binary
// search, whose masses are differences of prefix sums.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(set = 0, binding = 0, std430) readonly buffer Parts { ContextPart parts[]; };
layout(set = 0, binding = 1) uniform samplerBuffer positions;  // axes x faces
layout(set = 0, binding = 2) uniform samplerBuffer sorted;     // axes x samples, rising
layout(set = 0, binding = 3) uniform samplerBuffer prefixes;   // axes x class blocks x (samples + 1)
layout(set = 0, binding = 4, std430) writeonly buffer Histograms { float histograms[]; };

// The searches evaluate the same float expression |p - s| as the reference. It is monotonic on either side of p, so
// a sample on a bin's edge falls into the same bin.

vec4 sorted_at(uint first, uvec4 samples) {
    const ivec4 at = ivec4(first + samples);
    return vec4(texelFetch(sorted, at.x).x, texelFetch(sorted, at.y).x, texelFetch(sorted, at.z).x, texelFetch(sorted, at.w).x);
}

// Returns where four searches look next; those that have ended, at any sample.
uvec4 middle_of(uvec4 low, uvec4 high, uint samples) { return min((low + high) / 2, samples - 1); }

// Takes a step of four binary searches, where `beyond` tells which results are behind the middle.
void halve(uvec4 middle, bvec4 beyond, inout uvec4 low, inout uvec4 high) {
    const bvec4 goes_on = lessThan(low, high);
    const uvec4 next_low = mix(low, middle + 1, beyond), next_high = mix(middle, high, beyond);
    low = mix(low, next_low, goes_on);
    high = mix(high, next_high, goes_on);
}

// For each inner edge of the bins: the number of samples that lie before p by at least the edge, and the first sample
// that lies behind p by at least the edge. All searches take their steps together, so that their loads overlap.
void find_edges(uint first, uint samples, float p, vec4 edges, out uvec4 before, out uvec4 behind) {
    uvec4 before_end = uvec4(samples), behind_end = before_end;
    before = behind = uvec4(0);
    for (uint left = samples; left > 0; left /= 2) {
        const uvec4 a = middle_of(before, before_end, samples), b = middle_of(behind, behind_end, samples);
        const vec4 at_a = sorted_at(first, a), at_b = sorted_at(first, b);
        halve(a, greaterThanEqual(p - at_a, edges), before, before_end);
        halve(b, not(greaterThanEqual(at_b - p, edges)), behind, behind_end);
    }
}

vec4 prefix(uint index) { return texelFetch(prefixes, int(index)); }

void main() {
    const uint part = gl_WorkGroupID.z, axis = gl_WorkGroupID.y, face = gl_GlobalInvocationID.x;
    const uint faces = parts[part].faces, samples = parts[part].samples, classes = parts[part].classes;
    if (face >= faces) return;
    const float p = texelFetch(positions, int(k_context_axes * parts[part].first_face + axis * faces + face)).x;

    // Samples [before[b], behind[b]) are nearer than edge b. Bound 0 contains no sample, bound k_context_bins all.
    uint before[k_context_bins + 1], behind[k_context_bins + 1];
    before[k_context_bins] = 0;
    behind[k_context_bins] = samples;
    uvec4 before_edges, behind_edges;
    find_edges(k_context_axes * parts[part].first_sample + axis * samples, samples, p, parts[part].edges[axis], before_edges,
               behind_edges);
    for (uint b = 1; b < k_context_bins; ++b) {
        before[b] = before_edges[b - 1];
        behind[b] = max(behind_edges[b - 1], before[b]);
    }
    before[0] = behind[0] = before[1];

    const uint blocks = class_blocks(classes), target = parts[part].first_axes + face, stride = parts[part].stride;
    for (uint block = 0; block < blocks; ++block) {
        const uint first = parts[part].prefixes + (axis * blocks + block) * (samples + 1);
        const uint first_class = k_context_class_block * block;
        const uint count = min(k_context_class_block, classes - first_class);
        card_unroll for (uint b = 0; b < k_context_bins; ++b) {
            const vec4 mass = (prefix(first + behind[b + 1]) - prefix(first + behind[b])) +
                              (prefix(first + before[b]) - prefix(first + before[b + 1]));
            card_unroll for (uint c = 0; c < k_context_class_block; ++c)
                if (c < count) histograms[target + histogram_column(axis, b, classes, first_class + c) * stride] = mass[c];
        }
    }
}
