#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/loops.glsl"
#include "shaders/lib/tables.glsl"
#include "shaders/labeling/context_bins.glsl"
#include "shaders/shared/context.h"

// Contextual histograms over geodesic distance (thesis Eq. A.1): k_faces faces (x) and one block of four classes (y)
// per invocation. The faces of an invocation are `threads` apart, so that neighboring invocations
// read neighboring faces.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_faces = 1;
layout(push_constant) uniform Push { GeodesicContextParameters parameters; };
// Sample blocks x faces: the ranges from 16 samples to one face, one byte each; k_no_bin where there is no path.
layout(set = 0, binding = 0) uniform usamplerBuffer ranges;
layout(set = 0, binding = 1) vec4_table(Masses, masses);  // class blocks x 16 x sample blocks
layout(set = 0, binding = 2, std430) writeonly buffer Histograms { float histograms[]; };

#ifdef EXEMPLAR_CPU
vec4 mass_if(bool here, vec4 mass) { return here ? mass : vec4(0.0); }
#else
// Cards fuse the product with the sum.
vec4 mass_if(bool here, vec4 mass) { return (here ? 1.0 : 0.0) * mass; }
#endif

void main() {
    const uint thread = gl_GlobalInvocationID.x;
    const uint class_block = gl_WorkGroupID.y;
    const uint faces = parameters.faces, threads = parameters.threads, sample_blocks = parameters.sample_blocks;
    if (thread >= threads) return;

    vec4 bins[k_faces][k_context_bins];
    for (uint f = 0; f < k_faces; ++f)
        for (uint b = 0; b < k_context_bins; ++b) bins[f][b] = vec4(0.0);
    for (uint block = 0; block < sample_blocks; ++block) {
        uvec4 sixteen[k_faces];
        for (uint f = 0; f < k_faces; ++f)
            sixteen[f] = texelFetch(ranges, int(block * faces + min(thread + f * threads, faces - 1)));
        const uint first = k_context_sample_block * (class_block * sample_blocks + block);
        card_unroll for (uint j = 0; j < k_context_sample_block; ++j) {
            const vec4 mass = table_entry(masses, first + j);
            for (uint f = 0; f < k_faces; ++f) {
                const uint range = (sixteen[f][j / 4] >> (8 * (j % 4))) & 255u;
                for (uint b = 0; b < k_context_bins; ++b) bins[f][b] += mass_if(range == b, mass);
            }
        }
    }

    // On CPU drivers the loops below use dynamic indices. With this copy, only `result` has to lie in memory, not `bins`.
    vec4 result[k_faces * k_context_bins];
    for (uint f = 0; f < k_faces; ++f)
        for (uint b = 0; b < k_context_bins; ++b) result[f * k_context_bins + b] = bins[f][b];
    const uint first_class = k_context_class_block * class_block;
    const uint classes = min(k_context_class_block, parameters.classes - first_class);
    card_unroll for (uint f = 0; f < k_faces; ++f) {
        const uint face = thread + f * threads;
        card_unroll for (uint b = 0; b < k_context_bins; ++b)
            card_unroll for (uint c = 0; c < k_context_class_block; ++c)
                if (face < faces && c < classes)
                    histograms[histogram_column(0, b, parameters.classes, first_class + c) * faces + face] = result[f * k_context_bins + b][c];
    }
}
