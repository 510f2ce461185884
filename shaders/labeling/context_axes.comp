#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/loops.glsl"
#include "shaders/labeling/context_bins.glsl"
#include "shaders/shared/context.h"

// Contextual histograms over the distance along an axis (thesis Eq. A.1): one face (x) and one axis (y) per
// invocation. The samples are sorted along the axis. Those between two distances form two runs, found by binary
// search, whose masses are differences of prefix sums.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { AxisContextParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;  // axes x faces
layout(set = 0, binding = 1) uniform samplerBuffer sorted;     // axes x samples, rising
layout(set = 0, binding = 2) uniform samplerBuffer prefixes;   // axes x class blocks x (samples + 1)
layout(set = 0, binding = 3, std430) writeonly buffer Histograms { float histograms[]; };

// The searches evaluate the same float expression |p - s| as the reference. It is monotonic on either side of p, so
// a sample on a bin's edge falls into the same bin.

vec4 sorted_at(uint first, uvec4 samples) {
    const ivec4 at = ivec4(first + samples);
    return vec4(texelFetch(sorted, at.x).x, texelFetch(sorted, at.y).x, texelFetch(sorted, at.z).x, texelFetch(sorted, at.w).x);
}

// Returns where four searches look next; those that have ended, at any sample.
uvec4 middle_of(uvec4 low, uvec4 high) { return min((low + high) / 2, parameters.samples - 1); }

// Takes a step of four binary searches, where `beyond` tells which results are behind the middle.
void halve(uvec4 middle, bvec4 beyond, inout uvec4 low, inout uvec4 high) {
    const bvec4 goes_on = lessThan(low, high);
    const uvec4 next_low = mix(low, middle + 1, beyond), next_high = mix(middle, high, beyond);
    low = mix(low, next_low, goes_on);
    high = mix(high, next_high, goes_on);
}

// For each inner edge of the bins: the number of samples that lie before p by at least the edge, and the first sample
// that lies behind p by at least the edge. All searches take their steps together, so that their loads overlap.
void find_edges(uint first, float p, vec4 edges, out uvec4 before, out uvec4 behind) {
    uvec4 before_end = uvec4(parameters.samples), behind_end = before_end;
    before = behind = uvec4(0);
    for (uint left = parameters.samples; left > 0; left /= 2) {
        const uvec4 a = middle_of(before, before_end), b = middle_of(behind, behind_end);
        const vec4 at_a = sorted_at(first, a), at_b = sorted_at(first, b);
        halve(a, greaterThanEqual(p - at_a, edges), before, before_end);
        halve(b, not(greaterThanEqual(at_b - p, edges)), behind, behind_end);
    }
}

vec4 prefix(uint index) { return texelFetch(prefixes, int(index)); }

void main() {
    const uint face = gl_GlobalInvocationID.x;
    const uint axis = gl_GlobalInvocationID.y;
    if (face >= parameters.faces) return;
    const float p = texelFetch(positions, int(axis * parameters.faces + face)).x;

    // Samples [before[b], behind[b]) are nearer than edge b. Bound 0 contains no sample, bound k_context_bins all.
    uint before[k_context_bins + 1], behind[k_context_bins + 1];
    before[k_context_bins] = 0;
    behind[k_context_bins] = parameters.samples;
    uvec4 before_edges, behind_edges;
    find_edges(axis * parameters.samples, p, parameters.edges[axis], before_edges, behind_edges);
    for (uint b = 1; b < k_context_bins; ++b) {
        before[b] = before_edges[b - 1];
        behind[b] = max(behind_edges[b - 1], before[b]);
    }
    before[0] = behind[0] = before[1];

    const uint blocks = (parameters.classes + k_context_class_block - 1) / k_context_class_block;
    for (uint block = 0; block < blocks; ++block) {
        const uint first = (axis * blocks + block) * (parameters.samples + 1);
        const uint first_class = k_context_class_block * block;
        const uint classes = min(k_context_class_block, parameters.classes - first_class);
        card_unroll for (uint b = 0; b < k_context_bins; ++b) {
            const vec4 mass = (prefix(first + behind[b + 1]) - prefix(first + behind[b])) +
                              (prefix(first + before[b]) - prefix(first + before[b + 1]));
            card_unroll for (uint c = 0; c < k_context_class_block; ++c)
                if (c < classes) histograms[histogram_column(axis, b, parameters.classes, first_class + c) * parameters.faces + face] = mass[c];
        }
    }
}
