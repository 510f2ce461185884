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

// Returns the number of samples that lie before p by at least `edge`.
uint count_before(uint first, float p, float edge) {
    uint low = 0, high = parameters.samples;
    while (low < high) {
        const uint middle = (low + high) / 2;
        if (p - texelFetch(sorted, int(first + middle)).x >= edge) low = middle + 1;
        else high = middle;
    }
    return low;
}

// Returns the first sample that lies behind p by at least `edge`.
uint first_behind(uint first, float p, float edge) {
    uint low = 0, high = parameters.samples;
    while (low < high) {
        const uint middle = (low + high) / 2;
        if (texelFetch(sorted, int(first + middle)).x - p >= edge) high = middle;
        else low = middle + 1;
    }
    return low;
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
    keep_loop for (uint b = k_context_bins - 1; b > 0; --b) {
        before[b] = count_before(axis * parameters.samples, p, parameters.edges[axis][b - 1]);
        behind[b] = max(first_behind(axis * parameters.samples, p, parameters.edges[axis][b - 1]), before[b]);
    }
    before[0] = behind[0] = before[1];

    const uint blocks = (parameters.classes + k_context_class_block - 1) / k_context_class_block;
    for (uint block = 0; block < blocks; ++block) {
        const uint first = (axis * blocks + block) * (parameters.samples + 1);
        const uint first_class = k_context_class_block * block;
        const uint classes = min(k_context_class_block, parameters.classes - first_class);
        keep_loop for (uint b = 0; b < k_context_bins; ++b) {
            const vec4 mass = (prefix(first + behind[b + 1]) - prefix(first + behind[b])) +
                              (prefix(first + before[b]) - prefix(first + before[b + 1]));
            keep_loop for (uint c = 0; c < classes; ++c)
                histograms[histogram_column(axis, b, parameters.classes, first_class + c) * parameters.faces + face] = mass[c];
        }
    }
}
