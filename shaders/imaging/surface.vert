#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/imaging/painted_surface.glsl"

// Outputs vertices with the attributes that paint and light need. Both are constants, and buffers that they do not
// need are not read.
layout(constant_id = 0) const uint k_paint = 0;
layout(constant_id = 1) const uint k_light = 0;
layout(set = 0, binding = 2) uniform samplerBuffer normals;
layout(set = 0, binding = 3) uniform usamplerBuffer colors;  // of faces, sRGB, red lowest
layout(set = 0, binding = 4) uniform samplerBuffer first;    // e1, k1
layout(set = 0, binding = 5) uniform samplerBuffer second;   // e2, k2

layout(location = 0) out vec4 place;  // position, and curvature, scaled so that 1 has the strongest color
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 color;  // sRGB

const bool k_paints_curvature = k_paint >= k_paint_mean && k_paint <= k_paint_second;
const bool k_lit_by_vertex = k_light != k_light_none && k_light != k_light_flat;

float curvature_of(int vertex) {
    const float k1 = texelFetch(first, vertex).w, k2 = texelFetch(second, vertex).w;
    if (k_paint == k_paint_mean) return 0.5 * (k1 + k2);
    if (k_paint == k_paint_gauss) return sign(k1 * k2) * sqrt(abs(k1 * k2));
    return k_paint == k_paint_first ? k1 : k2;
}

void main() {
    const int vertex = drawn_vertex();
    const vec3 here = texelFetch(positions, vertex).xyz;
    place = vec4(here, k_paints_curvature ? parameters.curvature_scale * curvature_of(vertex) : 0.0);
    if (k_lit_by_vertex || k_paint == k_paint_normals) normal = texelFetch(normals, vertex).xyz;
    if (k_paint == k_paint_faces) color = unpackUnorm4x8(texelFetch(colors, gl_VertexIndex / 3).x).rgb;
    gl_Position = clip_position(here);
}
