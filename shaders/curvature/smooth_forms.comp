#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/curvature/diffusion.glsl"

// Diffuses second fundamental forms and turns to their principal frames, one vertex per invocation. Per vertex of n near ones
// 4 + 4 n bytes of topology and 48 of its position, normal, area and form are read and 32 written, each once; what the n need
// comes from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(set = 0, binding = 5, std430) writeonly buffer First { vec4 first[]; };    // e1, k1
layout(set = 0, binding = 6, std430) writeonly buffer Second { vec4 second[]; };  // e2, k2

vec4 spins_turned(vec4 spins, vec2 turn) {
    return vec4(spins.xy, pair_turned(spins.zw, turn_sum(turn, turn)));
}

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.vertices) return;
    const uint vertex = parameters.first + thread;

    const TangentFrame frame = any_frame(texelFetch(normals, int(vertex)).xyz);
    vec2 k;
    const vec2 turn = principal_turn(form_of_spins(diffused_spins(vertex, frame.normal)), k);
    first[vertex] = vec4(turn.x * frame.tangent + turn.y * frame.bitangent, parameters.scale * k.x);
    second[vertex] = vec4(turn.x * frame.bitangent - turn.y * frame.tangent, parameters.scale * k.y);
}
