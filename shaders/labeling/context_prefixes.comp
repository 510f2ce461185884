#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/labeling/context_layout.glsl"
#include "shaders/shared/context.h"

// Prefix sums of the samples' masses in the order along an axis: one axis (x) and one block of four classes (y) of one
// part (z) per workgroup. Each invocation sums a run of samples, adds the runs before it, and sums its run again. Runs
// are added in their order, so that a sum that ends a run is the one that begins the next, and sums never fall.
// Per sample 20 bytes are read, twice, and 16 written.
layout(local_size_x = k_prefix_runs) in;
layout(set = 0, binding = 0, std430) readonly buffer Parts { ContextPart parts[]; };
layout(set = 0, binding = 1, std430) readonly buffer Orders { uint orders[]; };  // axes x samples, by rising position
layout(set = 0, binding = 2, std430) readonly buffer Masses { vec4 masses[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Prefixes { vec4 prefixes[]; };

shared vec4 run_sums[k_prefix_runs];

void main() {
    const uint part = gl_WorkGroupID.z, block = gl_WorkGroupID.y, axis = gl_WorkGroupID.x;
    const uint blocks = class_blocks(parts[part].classes);
    if (block >= blocks) return;  // the whole workgroup

    const uint samples = parts[part].samples;
    const uint own = gl_LocalInvocationID.x, run = (samples + k_prefix_runs - 1) / k_prefix_runs;
    const uint begin = min(own * run, samples), end = min(begin + run, samples);
    const uint order = k_context_axes * parts[part].first_sample + axis * samples;
    const uint mass = parts[part].masses + block * k_context_sample_block * sample_blocks(samples);
    vec4 sum = vec4(0.0);
    for (uint j = begin; j < end; ++j) sum += masses[mass + orders[order + j]];
    run_sums[own] = sum;
    barrier();

    vec4 before = vec4(0.0);
    for (uint i = 0; i < own; ++i) before += run_sums[i];
    const uint first = parts[part].prefixes + (axis * blocks + block) * (samples + 1);
    if (own == 0) prefixes[first] = vec4(0.0);
    sum = vec4(0.0);
    for (uint j = begin; j < end; ++j) {
        sum += masses[mass + orders[order + j]];
        prefixes[first + j + 1] = before + sum;
    }
}
