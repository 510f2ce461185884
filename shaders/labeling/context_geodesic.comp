#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/context_bins.glsl"
#include "shaders/shared/context.h"

// Contextual histograms over geodesic distance (thesis Eq. A.1): one face (x) and one block of four classes (y) per invocation.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { GeodesicContextParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Distances { float distances[]; };  // samples x faces
layout(set = 0, binding = 1, std430) readonly buffer Masses { vec4 masses[]; };         // class blocks x samples
layout(set = 0, binding = 2, std430) writeonly buffer Histograms { float histograms[]; };

const float k_finite = 3.4e38;  // distances to other components are infinite and fall in no bin

void main() {
    const uint face = gl_GlobalInvocationID.x;
    const uint block = gl_GlobalInvocationID.y;
    if (face >= parameters.faces) return;

    vec4 bins[k_bins];
    for (uint b = 0; b < k_bins; ++b) bins[b] = vec4(0.0);
    for (uint j = 0; j < parameters.samples; ++j) {
        const float d = distances[j * parameters.faces + face];
        const vec4 mass = masses[block * parameters.samples + j];
        // beyond[b] is 1 where d has passed edge b; the differences mark the one bin that d is in, without branches.
        const vec4 beyond = vec4(greaterThanEqual(vec4(d), parameters.edges));
        const float finite = float(d < k_finite);
        bins[0] += (1.0 - beyond.x) * mass;
        bins[1] += (beyond.x - beyond.y) * mass;
        bins[2] += (beyond.y - beyond.z) * mass;
        bins[3] += (beyond.z - beyond.w) * mass;
        bins[4] += beyond.w * finite * mass;
    }
    for (uint b = 0; b < k_bins; ++b)
        for (uint c = 0; c < min(4u, parameters.classes - 4 * block); ++c)
            histograms[histogram_column(0, b, parameters.classes, 4 * block + c) * parameters.faces + face] = bins[b][c];
}
