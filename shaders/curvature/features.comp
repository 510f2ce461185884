#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Computes the features of a pose (exemplar::ComponentRegression), monomials of its inputs or neurons, one per
// invocation. Reads 16 bytes and three inputs per monomial, a row of weights and all inputs per neuron; writes 4.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { FeatureParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer table;          // CurvatureFeature
layout(set = 0, binding = 1) uniform samplerBuffer inputs;
layout(set = 0, binding = 2) uniform samplerBuffer inputs_by_four;  // the same
layout(set = 0, binding = 3) uniform samplerBuffer weights;         // neurons x input_texels; bias: at the input 1
layout(set = 0, binding = 4, std430) writeonly buffer Features { float features[]; };

float input_of(uint index) {
    return texelFetch(inputs, int(parameters.first_input + index)).x;
}

float neuron(uint index) {
    vec4 sum = vec4(0.0);
    for (uint i = 0; i < parameters.input_texels; ++i)
        sum += texelFetch(weights, int(index * parameters.input_texels + i)) *
               texelFetch(inputs_by_four, int(parameters.first_input / 4 + i));
    // Beyond 10, tanh is 1 in 32 bits, and devices may compute it from exponentials that overflow.
    return tanh(clamp(sum.x + sum.y + sum.z + sum.w, -10.0, 10.0));
}

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.features) return;

    const uvec4 feature = texelFetch(table, int(thread));
    features[thread] = feature.w != 0 ? neuron(feature.w - 1) : input_of(feature.x) * input_of(feature.y) * input_of(feature.z);
}
