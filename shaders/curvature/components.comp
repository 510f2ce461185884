#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/curvature.h"
#include "shaders/lib/row_lanes.glsl"

// Computes the components of the attributes of curvature (exemplar::ComponentRegression), each a row of
// coefficients times its features. Reads 16 bytes and 4 per coefficient, features from caches, and writes 4.
layout(push_constant) uniform Push { ComponentParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer table;        // CurvatureComponent
layout(set = 0, binding = 1) uniform samplerBuffer coefficients;  // padded with zeros
layout(set = 0, binding = 2) uniform samplerBuffer features;
layout(set = 0, binding = 3, std430) writeonly buffer Components { float components[]; };

void main() {
    const uint row = row_index();
    if (row >= parameters.components) return;

    const uvec4 component = texelFetch(table, int(row));
    vec4 sum = vec4(0.0);
    for (uint i = first_item(); i < component.y; i += k_row_lanes)
        sum += texelFetch(coefficients, int(component.z + i)) * texelFetch(features, int(component.x + i));
    sum = row_total(sum);
    if (first_item() == 0) components[row] = sum.x + sum.y + sum.z + sum.w;
}
