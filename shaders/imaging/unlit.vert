#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/imaging/painted_surface.glsl"

// Plain paint without light, the surface of most drawings: a CPU driver takes time for every output that is declared.
void main() {
    gl_Position = clip_position(texelFetch(positions, drawn_vertex()).xyz);
}
