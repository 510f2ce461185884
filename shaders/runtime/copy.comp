#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/ceilings.h"

// Copies vec4s, to measure the bandwidth that kernels can reach.
layout(local_size_x = 256) in;
layout(push_constant) uniform Push { CopyParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Source { vec4 source[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Target { vec4 target[]; };

void main() {
    const uint i = linear_thread();
    if (i < parameters.count) target[i] = source[i];
}
