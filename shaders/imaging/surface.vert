#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/paint.h"

// The vertices of a posed surface, pulled from the buffers that kernels left them in. What a look does without is neither
// read nor written: paint, light and how vertices come are constants.
layout(constant_id = 0) const uint k_paint = 0;
layout(constant_id = 1) const uint k_light = 0;
layout(constant_id = 2) const bool k_by_corner = true;  // else by index: vertices that faces share run once
layout(push_constant) uniform Push { PaintParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;  // x, y, z, 1
layout(set = 0, binding = 1) uniform usamplerBuffer faces;     // a, b, c, 0
layout(set = 0, binding = 2) uniform samplerBuffer normals;
layout(set = 0, binding = 3) uniform usamplerBuffer colors;  // of faces, sRGB, red lowest
layout(set = 0, binding = 4) uniform samplerBuffer first;    // e1, k1
layout(set = 0, binding = 5) uniform samplerBuffer second;   // e2, k2

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 color;  // sRGB
layout(location = 3) out float curvature;  // 1 has the strongest color

const bool k_paints_curvature = k_paint >= k_paint_mean && k_paint <= k_paint_second;
const bool k_lit_by_vertex = k_light != k_light_none && k_light != k_light_flat;

float curvature_of(int vertex) {
    const float k1 = texelFetch(first, vertex).w, k2 = texelFetch(second, vertex).w;
    if (k_paint == k_paint_mean) return 0.5 * (k1 + k2);
    if (k_paint == k_paint_gauss) return sign(k1 * k2) * sqrt(abs(k1 * k2));
    return k_paint == k_paint_first ? k1 : k2;
}

void main() {
    int vertex = gl_VertexIndex;
    if (k_by_corner) vertex = int(texelFetch(faces, gl_VertexIndex / 3)[gl_VertexIndex % 3]);
    const vec3 here = texelFetch(positions, vertex).xyz;
    if (k_light != k_light_none) position = here;
    if (k_lit_by_vertex || k_paint == k_paint_normals) normal = texelFetch(normals, vertex).xyz;
    if (k_paint == k_paint_faces) color = unpackUnorm4x8(texelFetch(colors, gl_VertexIndex / 3).x).rgb;
    if (k_paints_curvature) curvature = parameters.curvature_scale * curvature_of(vertex);
    gl_Position = parameters.matrix[0] * here.x + parameters.matrix[1] * here.y + parameters.matrix[2] * here.z +
                  parameters.matrix[3];
}
