#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/window.h"

// Pulls the vertices of the interface's triangles by their indices.
layout(push_constant) uniform Push { InterfaceParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Indices { uint indices[]; };
layout(set = 0, binding = 1, std430) readonly buffer Vertices { InterfaceVertex vertices[]; };

layout(location = 0) out vec2 place;  // in the atlas, 0 to 1
layout(location = 1) out vec4 color;  // sRGB, not premultiplied

void main() {
    const InterfaceVertex vertex = vertices[indices[gl_VertexIndex]];
    place = vec2(vertex.u, vertex.v);
    color = unpackUnorm4x8(vertex.color);
    gl_Position = vec4(vec2(vertex.x, vertex.y) * parameters.scale + parameters.offset, 0.0, 1.0);
}
