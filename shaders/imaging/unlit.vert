#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/imaging/painted_surface.glsl"

// Plain paint without light, which most drawings use, in a shader without outputs: D10 in docs/portability.md.
void main() {
    gl_Position = clip_position(texelFetch(positions, drawn_vertex()).xyz);
}
