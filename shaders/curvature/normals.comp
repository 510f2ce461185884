#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/curvature/face_fit.glsl"
#include "shaders/curvature/surface.glsl"

// Computes vertex normals, weighted as in Max 1999 (exemplar::vertex_normals), and vertex areas, one vertex per
// invocation. Per vertex with six faces 4 + 32 bytes of topology and 16 of position are read and 16 written, each
// once; the positions of its seven ring entries come from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(set = 0, binding = 3, std430) writeonly buffer Normals { vec4 normals[]; };

// Returns the contribution of a face: its normal, weighted by the sine of its angle over the product of the edge
// lengths, and its part of the vertex area.
vec4 share(vec3 a, vec3 b, vec3 ab) {
    const vec3 n = area_vector(a, b, ab);
    const float lengths = dot(a, a) * dot(b, b);
    return vec4(lengths > 0.0 ? n / lengths : vec3(0.0), corner_area(a, b, ab, length(n)));
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const vec3 here = position_of(vertex);
    vec4 sum = vec4(0.0);
    vec3 last = here;
    uint texel = texelFetch(ring_begin, int(vertex)).x;
    for (bool more = true; more; ++texel) {
        uvec4 entries = texelFetch(rings, int(texel));
        for (uint i = 0; i < 4 && more; ++i) {
            const vec3 there = position_of(entries.x & k_ring_vertex);
            if ((entries.x & k_ring_fan) == 0)
                sum += share(parameters.scale * (last - here), parameters.scale * (there - here),
                             parameters.scale * (there - last));
            last = there;
            more = (entries.x & k_ring_last) == 0;
            entries = entries.yzwx;
        }
    }
    const float size = length(sum.xyz);
    normals[vertex] = vec4(size > 0.0 ? sum.xyz / size : vec3(0.0, 0.0, 1.0),
                           sum.w / (parameters.scale * parameters.scale));
}
