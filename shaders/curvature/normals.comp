#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/face_fit.glsl"
#include "shaders/lib/surface.glsl"

// Vertex normals, weighted as in Max 1999 (exemplar::vertex_normals), one vertex per invocation. Per vertex of six faces
// 4 + 32 bytes of topology and 16 of its position are read and 16 written, each once; the positions of its seven ring
// entries come from caches.
layout(local_size_x = 64) in;
layout(set = 0, binding = 3, std430) writeonly buffer Normals { vec4 normals[]; };

vec3 weighted_normal(vec3 a, vec3 b, vec3 ab) {
    const float lengths = dot(a, a) * dot(b, b);
    return lengths > 0.0 ? area_vector(a, b, ab) / lengths : vec3(0.0);
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const vec3 here = position_of(vertex);
    vec3 sum = vec3(0.0), last = vec3(0.0);
    uint texel = texelFetch(ring_begin, int(vertex)).x;
    for (bool more = true; more; ++texel) {
        uvec4 entries = texelFetch(rings, int(texel));
        for (uint i = 0; i < 4 && more; ++i) {
            const vec3 there = position_of(entries.x & k_ring_vertex);
            const vec3 a = parameters.scale * (last - here), b = parameters.scale * (there - here);
            if ((entries.x & k_ring_fan) == 0) sum += weighted_normal(a, b, parameters.scale * (there - last));
            last = there;
            more = (entries.x & k_ring_last) == 0;
            entries = entries.yzwx;
        }
    }
    const float size = length(sum);
    normals[vertex] = vec4(size > 0.0 ? sum / size : vec3(0.0, 0.0, 1.0), 0.0);
}
