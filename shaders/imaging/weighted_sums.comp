#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/loops.glsl"
#include "shaders/shared/image_filters.h"

// Sums a line's pixels times a Gaussian and the powers 0 to k_orders - 1 of the offset, in units of sigma. An
// invocation computes k_outputs pixels of one line (y), so that each loaded pixel is used for all of them. The
// window holds the pixels that four weights of all outputs need, and moves on by four. Neighboring invocations (x)
// have pixels that are near in memory: of one line along x, of neighboring lines along y. Pixels outside of the line
// are zero.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const uint k_orders = 1;
layout(constant_id = 1) const uint k_outputs = 4;
layout(constant_id = 2) const bool k_along_x = false;
layout(push_constant) uniform Push { SumParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer image;
layout(set = 0, binding = 1) uniform samplerBuffer weights;  // in groups of four
layout(set = 0, binding = 2, std430) writeonly buffer Order0 { vec4 order0[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Order1 { vec4 order1[]; };
layout(set = 0, binding = 4, std430) writeonly buffer Order2 { vec4 order2[]; };
layout(set = 0, binding = 5, std430) writeonly buffer Order3 { vec4 order3[]; };

vec4 pixel_at(uint line, int place) {
    const int last = int(parameters.pixels) - 1;
    const vec4 here = texelFetch(image, int(line * parameters.line_step) + clamp(place, 0, last) * int(parameters.step));
    return place >= 0 && place <= last ? here : vec4(0.0);
}

// Returns the line of an invocation and its place there, line by line.
uvec2 place_on_line() {
    const uint thread = linear_thread(), per_line = (parameters.pixels + k_outputs - 1) / k_outputs;
    return uvec2(thread / per_line, thread % per_line);
}

void main() {
    const uvec2 place = k_along_x ? place_on_line() : gl_GlobalInvocationID.xy;
    const uint line = place.x, first = place.y * k_outputs;
    if (line >= parameters.lines || first >= parameters.pixels) return;
    int next = int(first) - int(parameters.radius);  // the pixel to load next
    vec4 window[k_outputs + 3];
    [[unroll]] for (uint i = 0; i + 1 < k_outputs; ++i) window[i] = pixel_at(line, next++);
    vec4 sums[k_orders * k_outputs];
    [[unroll]] for (uint i = 0; i < k_orders * k_outputs; ++i) sums[i] = vec4(0.0);

    keep_loop for (uint quad = 0; quad < parameters.quads; ++quad) {
        const vec4 four = texelFetch(weights, int(quad));
        [[unroll]] for (uint i = 0; i < 4; ++i) window[k_outputs - 1 + i] = pixel_at(line, next++);
        [[unroll]] for (uint tap = 0; tap < 4; ++tap) {
            const float offset = (float(4 * quad + tap) - float(parameters.radius)) * parameters.inverse_sigma;
            float weight = four[tap];
            [[unroll]] for (uint order = 0; order < k_orders; ++order) {
                [[unroll]] for (uint i = 0; i < k_outputs; ++i) sums[order * k_outputs + i] += weight * window[tap + i];
                weight *= offset;
            }
        }
        [[unroll]] for (uint i = 0; i + 1 < k_outputs; ++i) window[i] = window[i + 4];
    }

    [[unroll]] for (uint i = 0; i < k_outputs; ++i) {
        if (first + i >= parameters.pixels) break;
        const uint to = line * parameters.line_step + (first + i) * parameters.step;
        order0[to] = sums[i];
        if (k_orders > 1) order1[to] = sums[k_outputs + i];
        if (k_orders > 2) order2[to] = sums[2 * k_outputs + i];
        if (k_orders > 3) order3[to] = sums[3 * k_outputs + i];
    }
}
