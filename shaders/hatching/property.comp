#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching_features.h"

// Evaluates a stroke property (thesis Eq. 4.8) as a sum of logarithms. Four rows per invocation. Reads 48 bytes per
// term; writes 16.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { PropertyParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer terms;      // PropertyTerm, two texels each
layout(set = 0, binding = 1) uniform samplerBuffer features;    // columns x stride, four rows each
layout(set = 0, binding = 2, std430) writeonly buffer Values { vec4 values[]; };    // quads

// host/hatching/features/powers.h
vec4 power_of(vec4 x, uint power) {
    if (power == 0u) return x;
    if (power == 1u) return x * x;
    const vec4 least = mix(vec4(1e-6), vec4(-1e-6), lessThan(x, vec4(0.0)));
    const vec4 inverse = 1.0 / mix(x, least, lessThan(abs(x), vec4(1e-6)));
    return power == 2u ? inverse : inverse * inverse;
}

void main() {
    const uint quad = linear_thread();
    if (quad >= parameters.quads) return;

    vec4 sum = vec4(parameters.log_factor);
    for (uint k = 0; k < parameters.terms; ++k) {
        const uvec4 head = texelFetch(terms, int(2 * k));
        const vec4 tail = uintBitsToFloat(texelFetch(terms, int(2 * k + 1)));
        const float a = uintBitsToFloat(head.z), b = uintBitsToFloat(head.w), low = tail.y, high = tail.z;
        const vec4 x = texelFetch(features, int(head.x * parameters.stride + quad));
        const vec4 inside = mix(clamp(power_of(x, head.y), low, high), vec4(low), lessThan(x, vec4(k_no_value)));
        sum += tail.x * log(max(a * inside + b, tail.w));
    }
    values[quad] = exp(sum);
}
