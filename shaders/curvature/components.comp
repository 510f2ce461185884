#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Computes the components of the attributes of curvature (exemplar::ComponentRegression), one per invocation: a row
// of coefficients times its features. Reads 16 bytes and 4 per coefficient, features from caches, and writes 4.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { ComponentParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer table;        // CurvatureComponent
layout(set = 0, binding = 1) uniform samplerBuffer coefficients;  // padded with zeros
layout(set = 0, binding = 2) uniform samplerBuffer features;
layout(set = 0, binding = 3, std430) writeonly buffer Components { float components[]; };

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.components) return;

    const uvec4 component = texelFetch(table, int(thread));
    vec4 sum = vec4(0.0);
    for (uint i = 0; i < component.y; ++i)
        sum += texelFetch(coefficients, int(component.z + i)) * texelFetch(features, int(component.x + i));
    components[thread] = sum.x + sum.y + sum.z + sum.w;
}
