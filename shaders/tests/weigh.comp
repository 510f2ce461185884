#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/test_kernels.h"

// Computes one float per particle: its mass times the sum of its position's components, plus its id and a constant.
layout(local_size_x = 32) in;
layout(constant_id = 3) const float k_constant = 0.0;
layout(set = 0, binding = 0, std430) readonly buffer Particles { Particle particles[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Weights { float weights[]; };

void main() {
    const uint i = linear_thread();
    if (i >= particles.length()) return;
    const Particle p = particles[i];
    weights[i] = p.mass * dot(p.position, vec4(1.0)) + float(p.id) + k_constant;
}
