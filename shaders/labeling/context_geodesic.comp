#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/context_bins.glsl"
#include "shaders/shared/context.h"

// Contextual histograms over geodesic distance (thesis Eq. A.1): k_faces faces (x) and one block of four classes (y) per
// invocation. Loops whose bodies load or store stay loops: unrolled, they took a CPU driver seconds to compile. An invocation's faces are far apart, so that neighbors read neighboring faces.
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint k_faces = 1;
layout(push_constant) uniform Push { GeodesicContextParameters parameters; };
// Sample quads x faces: the ranges of one face seen from four samples, a byte each; k_no_bin where there is no path.
layout(set = 0, binding = 0, std430) readonly buffer Ranges { uint ranges[]; };
layout(set = 0, binding = 1, std430) readonly buffer Masses { vec4 masses[]; };  // class blocks x 4 x sample quads
layout(set = 0, binding = 2, std430) writeonly buffer Histograms { float histograms[]; };

void main() {
    const uint thread = gl_GlobalInvocationID.x;
    const uint block = gl_WorkGroupID.y;
    if (thread >= parameters.threads) return;

    vec4 bins[k_faces][k_bins];
    uint face[k_faces];
    for (uint f = 0; f < k_faces; ++f) {
        face[f] = min(thread + f * parameters.threads, parameters.faces - 1);
        for (uint b = 0; b < k_bins; ++b) bins[f][b] = vec4(0.0);
    }
    for (uint quad = 0; quad < parameters.sample_quads; ++quad) {
        uint four[k_faces];
        for (uint f = 0; f < k_faces; ++f) four[f] = ranges[quad * parameters.faces + face[f]];
        const uint first = 4 * (block * parameters.sample_quads + quad);
        [[dont_unroll]] for (uint j = 0; j < 4; ++j) {
            const vec4 mass = masses[first + j];
            for (uint f = 0; f < k_faces; ++f) {
                const uint range = (four[f] >> (8 * j)) & 255u;
                for (uint b = 0; b < k_bins; ++b) bins[f][b] += range == b ? mass : vec4(0.0);
            }
        }
    }
    const uint classes = min(4u, parameters.classes - 4 * block);
    [[dont_unroll]] for (uint f = 0; f < k_faces; ++f)
        [[dont_unroll]] for (uint b = 0; b < k_bins; ++b)
            [[dont_unroll]] for (uint c = 0; c < classes; ++c)
                if (thread + f * parameters.threads < parameters.faces)
                    histograms[histogram_column(0, b, parameters.classes, 4 * block + c) * parameters.faces + face[f]] = bins[f][b][c];
}
