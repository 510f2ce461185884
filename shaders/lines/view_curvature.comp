#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/eye.glsl"
#include "shaders/lib/view_curvature.glsl"
#include "shaders/shared/lines.h"

// Computes view-dependent curvature and its direction, one vertex per invocation. Reads 64 bytes and writes 16.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { FieldParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;
layout(set = 0, binding = 1) uniform samplerBuffer normals;
layout(set = 0, binding = 2) uniform samplerBuffer first;
layout(set = 0, binding = 3) uniform samplerBuffer second;
layout(set = 0, binding = 4, std430) writeonly buffer Views { vec4 views[]; };  // q, direction, n.w

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const vec3 here = texelFetch(positions, int(vertex)).xyz, normal = texelFetch(normals, int(vertex)).xyz;
    const vec3 w = to_eye(parameters.eye, here);
    const vec4 e1 = texelFetch(first, int(vertex)), e2 = texelFetch(second, int(vertex));
    const float cosine = dot(normal, w);
    views[vertex] = vec4(view_curvature(vec2(e1.w, e2.w), vec2(dot(e1.xyz, w), dot(e2.xyz, w)), cosine), cosine);
}
