#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/test_kernels.h"

// Computes value = value * factor + summand in place.
layout(local_size_x_id = 0) in;
layout(push_constant) uniform Push { AffineParameters parameters; };
layout(set = 0, binding = 0, std430) buffer Values { float values[]; };

void main() {
    const uint i = linear_thread();
    if (i < parameters.count) values[i] = values[i] * parameters.factor + parameters.summand;
}
