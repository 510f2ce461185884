#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/labeling/context_layout.glsl"
#include "shaders/shared/context.h"

// The masses that samples add to contextual histograms (thesis Eq. A.1): their area times the probability of a class.
// One sample (x) and one block of four classes (y) of one part (z) per invocation; 24 bytes read and 16 written.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { MassParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Parts { ContextPart parts[]; };
layout(set = 0, binding = 1, std430) readonly buffer Samples { ContextSample samples[]; };
layout(set = 0, binding = 2, std430) readonly buffer Probabilities { float probabilities[]; };  // rows x classes
layout(set = 0, binding = 3, std430) writeonly buffer Masses { vec4 masses[]; };

void main() {
    const uint part = gl_GlobalInvocationID.z, block = gl_GlobalInvocationID.y, j = gl_GlobalInvocationID.x;
    const uint classes = parts[part].classes;
    const uint padded = k_context_sample_block * sample_blocks(parts[part].samples);
    if (j >= padded || block >= class_blocks(classes)) return;

    vec4 mass = vec4(0.0);
    if (j < parts[part].samples) {
        const ContextSample here = samples[parts[part].first_sample + j];
        const uint row = here.row * parameters.classes + parts[part].first_class;
        const uint first = k_context_class_block * block;
        for (uint c = 0; c < k_context_class_block; ++c)
            if (first + c < classes) mass[c] = here.area * probabilities[row + first + c];
    }
    masses[parts[part].masses + block * padded + j] = mass;
}
