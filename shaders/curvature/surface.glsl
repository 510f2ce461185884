// Bindings of a deforming surface for kernels that gather over the faces around a vertex. The including shader
// declares its own buffers from binding 3 on.
#ifndef EXEMPLAR_SURFACE_GLSL
#define EXEMPLAR_SURFACE_GLSL
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Texel buffers: D4 in docs/portability.md.
layout(push_constant) uniform Push { SurfaceParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer ring_begin;  // per vertex, the first texel of its ring in `rings`
layout(set = 0, binding = 1) uniform usamplerBuffer rings;       // see k_ring_fan
layout(set = 0, binding = 2) uniform samplerBuffer positions;

vec3 position_of(uint vertex) {
    return texelFetch(positions, int(vertex)).xyz;
}

#endif
