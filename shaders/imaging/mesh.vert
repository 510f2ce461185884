#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/srgb.glsl"
#include "shaders/shared/render.h"

// Pulls the corners of triangles from storage buffers, so that no vertex is stored twice although every face has its
// own color.
layout(push_constant) uniform Push { RenderParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Corners { uint corners[]; };       // faces x 3, vertex indices
layout(set = 0, binding = 1, std430) readonly buffer Positions { float positions[]; };  // vertices x 3
layout(set = 0, binding = 2, std430) readonly buffer Normals { float normals[]; };      // vertices or faces, x 3
layout(set = 0, binding = 3, std430) readonly buffer Colors { uint colors[]; };         // faces, sRGB, red lowest

layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 color;  // linear

void main() {
    const uint corner = uint(gl_VertexIndex);
    const uint face = corner / 3;
    const uint vertex = corners[corner];
    const uint n = parameters.vertex_normals != 0 ? vertex : face;
    position = vec3(positions[3 * vertex], positions[3 * vertex + 1], positions[3 * vertex + 2]);
    normal = vec3(normals[3 * n], normals[3 * n + 1], normals[3 * n + 2]);
    color = srgb_to_linear(unpackUnorm4x8(colors[face]).rgb);
    gl_Position = parameters.matrix[0] * position.x + parameters.matrix[1] * position.y +
                  parameters.matrix[2] * position.z + parameters.matrix[3];
}
