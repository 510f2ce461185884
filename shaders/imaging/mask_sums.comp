#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/loops.glsl"
#include "shaders/lib/tables.glsl"
#include "shaders/shared/image_filters.h"

// Does what weighted_sums.comp does for the mask, which is one number per pixel: lane k of the result has the power
// k of the offset.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 1) const uint k_outputs = 4;
layout(push_constant) uniform Push { SumParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer inside;   // 1 or 0
layout(set = 0, binding = 1) vec4_table(Weights, weights);   // in groups of four
layout(set = 0, binding = 2, std430) writeonly buffer Orders { vec4 orders[]; };

float inside_at(uint line, int place) {
    const int last = int(parameters.pixels) - 1;
    const float here = texelFetch(inside, int(line * parameters.line_step) + clamp(place, 0, last) * int(parameters.step)).x;
    return place >= 0 && place <= last ? here : 0.0;
}

void main() {
    const uint thread = linear_thread(), per_line = (parameters.pixels + k_outputs - 1) / k_outputs;
    const uint line = thread / per_line, first = thread % per_line * k_outputs;
    if (line >= parameters.lines || first >= parameters.pixels) return;
    int next = int(first) - int(parameters.radius);
    float window[k_outputs + 3];
    [[unroll]] for (uint i = 0; i + 1 < k_outputs; ++i) window[i] = inside_at(line, next++);
    vec4 sums[k_outputs];
    [[unroll]] for (uint i = 0; i < k_outputs; ++i) sums[i] = vec4(0.0);

    keep_loop for (uint quad = 0; quad < parameters.quads; ++quad) {
        const vec4 four = table_entry(weights, quad);
        [[unroll]] for (uint i = 0; i < 4; ++i) window[k_outputs - 1 + i] = inside_at(line, next++);
        [[unroll]] for (uint tap = 0; tap < 4; ++tap) {
            const float offset = (float(4 * quad + tap) - float(parameters.radius)) * parameters.inverse_sigma;
            const vec4 weight = four[tap] * vec4(1.0, offset, offset * offset, offset * offset * offset);
            [[unroll]] for (uint i = 0; i < k_outputs; ++i) sums[i] += window[tap + i] * weight;
        }
        [[unroll]] for (uint i = 0; i + 1 < k_outputs; ++i) window[i] = window[i + 4];
    }

    [[unroll]] for (uint i = 0; i < k_outputs; ++i)
        if (first + i < parameters.pixels) orders[line * parameters.line_step + (first + i) * parameters.step] = sums[i];
}
