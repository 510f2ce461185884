#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/hatching_features.h"

// Interpolates the columns of a slab at points of faces (host/hatching/features/pixel_projection.cpp). Four points
// per invocation, so that a corner's texel serves four columns, and a written texel four points. Reads 192 bytes and
// writes 64 per quad of columns.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { ProjectionParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer corners;       // per face, a b c 0
layout(set = 0, binding = 1) uniform usamplerBuffer point_faces;   // four points per texel
layout(set = 0, binding = 2) uniform samplerBuffer barycentrics;   // four points per texel; corner 1, then corner 2
layout(set = 0, binding = 3) uniform samplerBuffer slab;           // vertices x k_slab_quads
layout(set = 0, binding = 4, std430) writeonly buffer Columns { vec4 columns[]; };  // columns x stride / 4

void main() {
    const uint quad = linear_thread(), stride = parameters.stride / 4;
    if (4 * quad >= parameters.points) return;

    const uvec4 faces = texelFetch(point_faces, int(quad));
    const vec4 b = texelFetch(barycentrics, int(quad)), c = texelFetch(barycentrics, int(stride + quad));
    ivec3 first[4];
    [[unroll]] for (uint i = 0; i < 4; ++i) first[i] = ivec3(k_slab_quads * texelFetch(corners, int(faces[i])).xyz);
    for (uint q = 0; q < parameters.quads; ++q) {
        mat4 values;
        [[unroll]] for (uint i = 0; i < 4; ++i) {
            const ivec3 at = first[i] + int(q);
            values[i] = (1.0 - b[i] - c[i]) * texelFetch(slab, at.x) + b[i] * texelFetch(slab, at.y) +
                        c[i] * texelFetch(slab, at.z);
        }
        values = transpose(values);
        [[unroll]] for (uint lane = 0; lane < 4; ++lane) columns[(4 * q + lane) * stride + quad] = values[lane];
    }
}
