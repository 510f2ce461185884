#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/ceilings.h"

// Adds to counters, to measure the rate of atomic additions. In each round, each invocation adds one to another counter,
// and all counters get one.
layout(local_size_x = 256) in;
layout(push_constant) uniform Push { RoundParameters parameters; };
layout(set = 0, binding = 0, std430) buffer Counters { uint counters[]; };

void main() {
    const uint i = linear_thread();
    const uint count = counters.length();
    if (i >= count) return;
    for (uint round = 0; round < parameters.rounds; ++round) atomicAdd(counters[(i + 64u * round) % count], 1u);
}
