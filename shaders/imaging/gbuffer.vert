#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/gbuffer.h"

// Draws the faces without an index buffer: the shader runs for each corner, so that it knows the number of the face.
layout(push_constant) uniform Push { FaceParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;  // x, y, z, 1
layout(set = 0, binding = 1) uniform usamplerBuffer faces;     // a, b, c, 0

layout(location = 0) flat out uint number;  // face number, starting with 1

void main() {
    const int face = gl_VertexIndex / 3;
    const vec3 here = texelFetch(positions, int(texelFetch(faces, face)[gl_VertexIndex % 3])).xyz;
    number = parameters.first_face + uint(face) + 1;
    gl_Position = parameters.matrix[0] * here.x + parameters.matrix[1] * here.y + parameters.matrix[2] * here.z +
                  parameters.matrix[3];
}
