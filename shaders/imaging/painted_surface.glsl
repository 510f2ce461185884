// Vertices of a posed surface, read from the buffers that kernels wrote.
#ifndef EXEMPLAR_PAINTED_SURFACE_GLSL
#define EXEMPLAR_PAINTED_SURFACE_GLSL
#include "shaders/shared/paint.h"

layout(constant_id = 2) const bool k_by_corner = true;  // else by index: shared vertices are processed once
layout(push_constant) uniform Push { PaintParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;  // x, y, z, 1
layout(set = 0, binding = 1) uniform usamplerBuffer faces;     // a, b, c, 0

int drawn_vertex() {
    return k_by_corner ? int(texelFetch(faces, gl_VertexIndex / 3)[gl_VertexIndex % 3]) : gl_VertexIndex;
}

vec4 clip_position(vec3 here) {
    return parameters.matrix[0] * here.x + parameters.matrix[1] * here.y + parameters.matrix[2] * here.z +
           parameters.matrix[3];
}

#endif
