#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/curvature.h"

// Computes morphing and then linear blend skinning (exemplar::pose_vertices), one vertex per invocation. Each
// invocation gathers, so no two write to one place. Per vertex with i influences and m morph offsets 16 + 16 ceil(i
// / 2) + 4 + 16 m bytes are read and 16 written, each once; the pose, 48 bytes per bone and 4 per target, stays in
// caches. Inputs are texel buffers (D4 in docs/portability.md).
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { PoseParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer rest;         // RestVertex; uints: D14 in docs/portability.md
layout(set = 0, binding = 1) uniform usamplerBuffer influences;   // InfluencePair
layout(set = 0, binding = 2) uniform usamplerBuffer morph_begin;  // per vertex; empty without targets
layout(set = 0, binding = 3) uniform usamplerBuffer morphs;       // MorphOffset
layout(set = 0, binding = 4) uniform samplerBuffer palette;       // three rows of a 3 x 4 matrix per bone
layout(set = 0, binding = 5) uniform samplerBuffer pose;          // the palette, then a weight per target, as floats
layout(set = 0, binding = 6, std430) writeonly buffer Vertices { vec4 vertices[]; };

vec3 morphed(vec3 position, uint vertex) {
    uint next = texelFetch(morph_begin, int(vertex)).x;
    for (bool more = next != 0; more; ++next) {
        const uvec4 morph = texelFetch(morphs, int(next));
        const uint target = morph.w & ~k_last_of_vertex;
        position += texelFetch(pose, int(parameters.first_weight + target)).x * uintBitsToFloat(morph.xyz);
        more = (morph.w & k_last_of_vertex) == 0;
    }
    return position;
}

mat3x4 weighted_rows(uint bone, float weight) {
    const int row = int(3 * bone);
    return weight * mat3x4(texelFetch(palette, row), texelFetch(palette, row + 1), texelFetch(palette, row + 2));
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const uvec4 at_rest = texelFetch(rest, int(vertex));
    vec3 position = uintBitsToFloat(at_rest.xyz);
    if (parameters.targets != 0) position = morphed(position, vertex);

    mat3x4 rows = mat3x4(0.0);
    uint next = at_rest.w;
    for (bool more = true; more; ++next) {
        const uvec4 pair = texelFetch(influences, int(next));
        rows += weighted_rows(pair.x & ~k_last_of_vertex, uintBitsToFloat(pair.y));
        rows += weighted_rows(pair.z, uintBitsToFloat(pair.w));
        more = (pair.x & k_last_of_vertex) == 0;
    }
    vertices[vertex] = vec4(vec4(position, 1.0) * rows, 1.0);
}
