#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/curvature/diffusion.glsl"

// Diffuses second fundamental forms and computes their principal frames, one vertex per invocation. Per vertex with
// n nearby vertices 4 + 4 n bytes of topology and 48 of position, normal, area and form are read and 32 written,
// each once; the data of the n vertices comes from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(set = 0, binding = 5, std430) writeonly buffer First { vec4 first[]; };    // e1, k1
layout(set = 0, binding = 6, std430) writeonly buffer Second { vec4 second[]; };  // e2, k2

vec4 turned_angular_components(vec4 angular_components, vec2 turn) {
    return vec4(angular_components.xy, pair_turned(angular_components.zw, turn_sum(turn, turn)));
}

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.vertices) return;
    const uint vertex = parameters.first + thread;

    const TangentFrame frame = frame_of_normal(texelFetch(normals, int(vertex)).xyz);
    vec2 k;
    const vec2 turn = principal_rotation(form_of_angular_components(diffused_angular_components(vertex, frame.normal)), k);
    first[vertex] = vec4(turn.x * frame.tangent + turn.y * frame.bitangent, parameters.scale * k.x);
    second[vertex] = vec4(turn.x * frame.bitangent - turn.y * frame.tangent, parameters.scale * k.y);
}
