#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/loops.glsl"
#include "shaders/lib/tables.glsl"
#include "shaders/labeling/context_layout.glsl"
#include "shaders/shared/context.h"

// Contextual histograms over geodesic distance (thesis Eq. A.1): k_faces faces (x) and one block of four classes (y)
// of one part (z) per invocation. The faces of an invocation are as far apart as a part has invocations, so that
// neighboring invocations read neighboring faces.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_faces = 1;
layout(set = 0, binding = 0, std430) readonly buffer Parts { ContextPart parts[]; };
// Sample blocks x faces: the ranges from 32 samples to one face, four bits each; k_context_bins or more where there is
// no path.
layout(set = 0, binding = 1) uniform usamplerBuffer ranges;
layout(set = 0, binding = 2) vec4_table(Masses, masses);  // class blocks x 32 x sample blocks
layout(set = 0, binding = 3, std430) writeonly buffer Histograms { float histograms[]; };

const uint k_of_word = 8;  // samples

#ifdef EXEMPLAR_CPU
vec4 mass_if(bool here, vec4 mass) { return here ? mass : vec4(0.0); }
#else
// Cards fuse the product with the sum.
vec4 mass_if(bool here, vec4 mass) { return (here ? 1.0 : 0.0) * mass; }
#endif

void main() {
    const uint part = gl_WorkGroupID.z, class_block = gl_WorkGroupID.y, thread = gl_GlobalInvocationID.x;
    const uint faces = parts[part].faces, classes = parts[part].classes;
    const uint threads = (faces + k_faces - 1) / k_faces;
    if (thread >= threads || class_block >= class_blocks(classes)) return;

    const uint first_range = parts[part].ranges, blocks = sample_blocks(parts[part].samples);
    const uint first_mass = parts[part].masses + k_context_sample_block * class_block * blocks;
    vec4 bins[k_faces][k_context_bins];
    for (uint f = 0; f < k_faces; ++f)
        for (uint b = 0; b < k_context_bins; ++b) bins[f][b] = vec4(0.0);
    for (uint block = 0; block < blocks; ++block) {
        uvec4 near[k_faces];
        for (uint f = 0; f < k_faces; ++f)
            near[f] = texelFetch(ranges, int(first_range + block * faces + min(thread + f * threads, faces - 1)));
        const uint first = first_mass + k_context_sample_block * block;
        card_unroll for (uint j = 0; j < k_context_sample_block; ++j) {
            const vec4 mass = table_entry(masses, first + j);
            for (uint f = 0; f < k_faces; ++f) {
                const uint range = (near[f][j / k_of_word] >> (4 * (j % k_of_word))) & 15u;
                for (uint b = 0; b < k_context_bins; ++b) bins[f][b] += mass_if(range == b, mass);
            }
        }
    }

    // On CPU drivers the loops below use dynamic indices. With this copy, only `result` has to lie in memory, not `bins`.
    vec4 result[k_faces * k_context_bins];
    for (uint f = 0; f < k_faces; ++f)
        for (uint b = 0; b < k_context_bins; ++b) result[f * k_context_bins + b] = bins[f][b];
    const uint first_class = k_context_class_block * class_block;
    const uint count = min(k_context_class_block, classes - first_class);
    const uint target = parts[part].first_geodesic, stride = parts[part].stride;
    card_unroll for (uint f = 0; f < k_faces; ++f) {
        const uint face = thread + f * threads;
        card_unroll for (uint b = 0; b < k_context_bins; ++b)
            card_unroll for (uint c = 0; c < k_context_class_block; ++c)
                if (face < faces && c < count)
                    histograms[target + histogram_column(0, b, classes, first_class + c) * stride + face] =
                        result[f * k_context_bins + b][c];
    }
}
