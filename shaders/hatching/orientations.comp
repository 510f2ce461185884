#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching_features.h"

// Evaluates orientation functions (thesis Eq. 4.7), each row by the rule of its segment. One row per invocation.
// Reads 8 bytes, and 24 per term; writes 8.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { RuleParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer segments;   // per row
layout(set = 0, binding = 1) uniform usamplerBuffer begins;     // per segment, and the end
layout(set = 0, binding = 2) uniform usamplerBuffer terms;      // RuleTerm
layout(set = 0, binding = 3, std430) readonly buffer Fields { vec2 fields[]; };             // fields x stride
layout(set = 0, binding = 4, std430) writeonly buffer Directions { vec2 directions[]; };    // rows

void main() {
    const uint row = linear_thread();
    if (row >= parameters.rows) return;

    const int segment = int(texelFetch(segments, int(row)).x);
    const uint end = texelFetch(begins, segment + 1).x;
    vec2 sum = vec2(0.0);
    for (uint k = texelFetch(begins, segment).x; k < end; ++k) {
        const uvec4 term = texelFetch(terms, int(k));
        sum += uintBitsToFloat(term.y) * fields[term.x * parameters.stride + row];
    }
    const float size = length(sum);
    directions[row] = size > 1e-6 ? sum / size : vec2(0.0);
}
