#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/ceilings.h"

// Runs eight independent chains of fused multiply-adds per invocation, to measure the arithmetic rate that kernels
// can reach.
layout(local_size_x = 256) in;
layout(push_constant) uniform Push { MultiplyAddParameters parameters; };
layout(set = 0, binding = 0, std430) writeonly buffer Result { float result[]; };

void main() {
    const vec4 factor = vec4(parameters.factor);
    const vec4 summand = vec4(parameters.summand);
    const uint i = linear_thread();
    const vec4 start = vec4(float(i) * 1e-6) + vec4(0.0, 0.1, 0.2, 0.3);
    vec4 a = start, b = start + 1.0, c = start + 2.0, d = start + 3.0;
    vec4 e = start + 4.0, f = start + 5.0, g = start + 6.0, h = start + 7.0;
    for (uint round = 0; round < parameters.rounds; ++round) {
        a = fma(a, factor, summand);
        b = fma(b, factor, summand);
        c = fma(c, factor, summand);
        d = fma(d, factor, summand);
        e = fma(e, factor, summand);
        f = fma(f, factor, summand);
        g = fma(g, factor, summand);
        h = fma(h, factor, summand);
    }
    const vec4 sum = a + b + c + d + e + f + g + h;
    if (i < result.length()) result[i] = sum.x + sum.y + sum.z + sum.w;
}
