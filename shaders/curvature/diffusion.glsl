// Diffuses tensors over a surface (exemplar::TensorDiffusion): the mean of the tensors around a vertex, weighted by
// a Gaussian of their distance and by vertex area, and transported to its frame by the minimal rotation. Tensors are
// given by irreducible components (to_angular_components). The including shader defines their rotation, turned_angular_components(), and
// declares its outputs from binding 5 on.
#ifndef EXEMPLAR_DIFFUSION_GLSL
#define EXEMPLAR_DIFFUSION_GLSL
#include "shaders/lib/dispatch.glsl"
#include "shaders/curvature/tangent.glsl"
#include "shaders/shared/curvature.h"

layout(push_constant) uniform Push { DiffusionParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer near_begin;  // per vertex, the first texel of its row in `near`
layout(set = 0, binding = 1) uniform usamplerBuffer near;        // the tile's rows, see k_near_last
layout(set = 0, binding = 2) uniform samplerBuffer positions;
layout(set = 0, binding = 3) uniform samplerBuffer normals;  // and areas
layout(set = 0, binding = 4) uniform samplerBuffer tensors;  // to_angular_components, in the frames frame_of_normal(normal)

// Returns the components of a tensor in a frame rotated by `turn`.
vec4 turned_angular_components(vec4 angular_components, vec2 turn);

vec2 pair_turned(vec2 pair, vec2 turn) {
    return vec2(turn.x * pair.x + turn.y * pair.y, turn.x * pair.y - turn.y * pair.x);
}

vec2 turn_sum(vec2 a, vec2 b) {
    return vec2(a.x * b.x - a.y * b.y, a.y * b.x + a.x * b.y);
}

vec4 diffused_angular_components(uint vertex, vec3 normal_here) {
    const vec4 spinor = spinor_of_frame(normal_here);
    const vec3 here = texelFetch(positions, int(vertex)).xyz;
    // The area is bounded below so that a vertex with no faces or only degenerate ones keeps its value.
    float total = max(texelFetch(normals, int(vertex)).w, 1e-37) * (1.0 - k_diffusion_rest);
    vec4 sum = total * texelFetch(tensors, int(vertex));
    uint texel = texelFetch(near_begin, int(vertex)).x - parameters.near_first;
    for (bool more = true; more; ++texel) {
        uvec4 four = texelFetch(near, int(texel));
        more = (four.w & k_near_last) == 0;
        for (uint i = 0; i < 4; ++i) {
            const uint other = four.x & k_near_vertex;
            const vec3 apart = parameters.scale * (texelFetch(positions, int(other)).xyz - here);
            const vec4 normal = texelFetch(normals, int(other));
            const float squared = dot(apart, apart);
            // Transport across a sharp fold is meaningless; the cosine reduces its weight gradually.
            const float cosine = max(dot(normal.xyz, normal_here), 0.0);
            const float kernel = exp(squared * parameters.exponent) - k_diffusion_rest;
            const float weight = squared < parameters.limit && other != vertex ? normal.w * cosine * kernel : 0.0;
            const vec2 turn = turn_between(spinor_of_frame(normal.xyz), spinor);
            sum += weight * turned_angular_components(texelFetch(tensors, int(other)), turn);
            total += weight;
            four = four.yzwx;
        }
    }
    return sum / total;
}

#endif
