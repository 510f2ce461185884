#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/loops.glsl"
#include "shaders/lib/tables.glsl"
#include "shaders/labeling/context_layout.glsl"
#include "shaders/shared/context.h"

// Adds the part of a linear classifier (LinearClassifier) that reads contextual histograms to its scores: k_rows rows
// (x) and one block of four classes (y) per invocation. The rows of an invocation are `threads` apart, so that neighboring
// invocations read neighboring rows. Reads the histograms of a row, and reads and writes its scores.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_rows = 1;
layout(push_constant) uniform Push { LinearParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Geodesic { float geodesic[]; };  // columns x rows
layout(set = 0, binding = 1, std430) readonly buffer Axes { float axes[]; };          // the same
// Per column of the histograms: mean and inverse deviation, then the weights of each block of classes.
layout(set = 0, binding = 2) vec4_table(Weights, weights);
layout(set = 0, binding = 3, std430) buffer Scores { float scores[]; };  // rows x classes

float standardized(float value, vec4 standard) {
    return clamp((value - standard.x) * standard.y, -k_max_deviations, k_max_deviations);
}

void main() {
    const uint thread = gl_GlobalInvocationID.x, block = gl_WorkGroupID.y;
    if (thread >= parameters.threads) return;
    const uint blocks = class_blocks(parameters.classes), last = parameters.rows - 1;
    const uint of_geodesic = k_context_bins * parameters.classes;
    vec4 sum[k_rows];
    for (uint r = 0; r < k_rows; ++r) sum[r] = vec4(0.0);
    keep_loop for (uint f = 0; f < of_geodesic; ++f) {
        const vec4 standard = table_entry(weights, f * (1 + blocks));
        const vec4 weight = table_entry(weights, f * (1 + blocks) + 1 + block);
        for (uint r = 0; r < k_rows; ++r) {
            const uint row = min(thread + r * parameters.threads, last);
            sum[r] += standardized(geodesic[f * parameters.rows + row], standard) * weight;
        }
    }
    keep_loop for (uint f = 0; f < k_context_axes * of_geodesic; ++f) {
        const vec4 standard = table_entry(weights, (of_geodesic + f) * (1 + blocks));
        const vec4 weight = table_entry(weights, (of_geodesic + f) * (1 + blocks) + 1 + block);
        for (uint r = 0; r < k_rows; ++r) {
            const uint row = min(thread + r * parameters.threads, last);
            sum[r] += standardized(axes[f * parameters.rows + row], standard) * weight;
        }
    }
    const uint first_class = k_context_class_block * block;
    const uint count = min(k_context_class_block, parameters.classes - first_class);
    for (uint r = 0; r < k_rows; ++r) {
        const uint row = thread + r * parameters.threads;
        card_unroll for (uint c = 0; c < k_context_class_block; ++c)
            if (row <= last && c < count) scores[row * parameters.classes + first_class + c] += sum[r][c];
    }
}
