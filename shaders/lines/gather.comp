#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Gives the vertices of a cut surface what those have that they were cut from (exemplar::SplitSurface::source), one
// vertex per invocation. Per vertex 4 + 16 bytes are read and 16 written.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { GatherParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer source;  // per vertex of the cut surface
layout(set = 0, binding = 1) uniform samplerBuffer whole;    // per vertex of the whole surface
layout(set = 0, binding = 2, std430) writeonly buffer Cut { vec4 cut[]; };

void main() {
    const uint vertex = linear_thread();
    if (vertex < parameters.vertices) cut[vertex] = texelFetch(whole, int(texelFetch(source, int(vertex)).x));
}
