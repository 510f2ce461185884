#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/srgb.glsl"
#include "shaders/shared/window.h"

// The corners of a posed surface, pulled from the buffers that kernels left them in.
layout(push_constant) uniform Push { PaintParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer faces;     // a, b, c, 0
layout(set = 0, binding = 1) uniform samplerBuffer positions;  // x, y, z, 1
layout(set = 0, binding = 2) uniform samplerBuffer normals;
layout(set = 0, binding = 3) uniform usamplerBuffer colors;  // of faces, sRGB, red lowest
layout(set = 0, binding = 4) uniform samplerBuffer first;    // e1, k1
layout(set = 0, binding = 5) uniform samplerBuffer second;   // e2, k2

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 color;  // linear
layout(location = 3) out float curvature;  // 1 has the strongest color

float curvature_of(int vertex) {
    const float k1 = texelFetch(first, vertex).w, k2 = texelFetch(second, vertex).w;
    if (parameters.paint == k_paint_mean) return 0.5 * (k1 + k2);
    if (parameters.paint == k_paint_gauss) return sign(k1 * k2) * sqrt(abs(k1 * k2));
    return parameters.paint == k_paint_first ? k1 : k2;
}

bool paints_curvature() {
    return parameters.paint >= k_paint_mean && parameters.paint <= k_paint_second;
}

void main() {
    const int face = gl_VertexIndex / 3;
    const int vertex = int(texelFetch(faces, face)[gl_VertexIndex % 3]);
    position = texelFetch(positions, vertex).xyz;
    normal = texelFetch(normals, vertex).xyz;
    const uint packed = parameters.paint == k_paint_faces ? texelFetch(colors, face).x : parameters.plain;
    color = srgb_to_linear(unpackUnorm4x8(packed).rgb);
    curvature = paints_curvature() ? parameters.curvature_scale * curvature_of(vertex) : 0.0;
    gl_Position = parameters.matrix[0] * position.x + parameters.matrix[1] * position.y +
                  parameters.matrix[2] * position.z + parameters.matrix[3];
}
