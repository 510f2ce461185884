#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/lines.h"

// The surface under the lines: corners of faces, with a color.
layout(push_constant) uniform Push { SurfaceDrawParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer faces;
layout(set = 0, binding = 1) uniform samplerBuffer positions;
layout(set = 0, binding = 2) uniform samplerBuffer normals;
layout(set = 0, binding = 3) uniform usamplerBuffer colors;  // of faces, sRGB, red lowest
layout(set = 0, binding = 4) uniform samplerBuffer first;    // e1, k1
layout(set = 0, binding = 5) uniform samplerBuffer second;

layout(location = 0) out vec3 to_eye;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec3 color;  // sRGB

// From blue where the surface is hollow over white to red where it bulges, of mean curvature.
vec3 curvature_color(int vertex) {
    const float mean = 0.5 * parameters.scale * (texelFetch(first, vertex).w + texelFetch(second, vertex).w);
    const float t = mean / (1.0 + abs(mean));
    return mix(vec3(0.95), t > 0.0 ? vec3(0.80, 0.20, 0.15) : vec3(0.15, 0.35, 0.80), abs(t));
}

void main() {
    const int face = gl_VertexIndex / 3;
    const int vertex = int(texelFetch(faces, face)[gl_VertexIndex % 3]);
    const vec3 here = texelFetch(positions, vertex).xyz;
    gl_Position = parameters.matrix[0] * here.x + parameters.matrix[1] * here.y + parameters.matrix[2] * here.z +
                  parameters.matrix[3];
    normal = vec3(0.0);
    if (parameters.paper.w != 0.0) normal = texelFetch(normals, vertex).xyz;
    to_eye = parameters.eye.w != 0.0 ? parameters.eye.xyz - here : parameters.eye.xyz;
    color = parameters.paper.rgb;
    if (parameters.coloring == 1u) color = unpackUnorm4x8(texelFetch(colors, face).x).rgb;
    if (parameters.coloring == 2u) color = curvature_color(vertex);
}
