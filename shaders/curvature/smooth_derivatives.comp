#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/curvature/diffusion.glsl"

// Diffuses derivatives of curvature and rotates them to the principal frames, one vertex per invocation. Per vertex
// with n nearby vertices 4 + 4 n bytes of topology and 64 of position, normal, area, derivative and principal
// direction are read and 16 written, each once; the data of the n vertices comes from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(set = 0, binding = 5) uniform samplerBuffer first;  // e1, k1
layout(set = 0, binding = 6, std430) writeonly buffer Derivatives { vec4 derivatives[]; };

vec4 turned_angular_components(vec4 angular_components, vec2 turn) {
    const vec2 thrice = turn_sum(turn_sum(turn, turn), turn);
    return vec4(pair_turned(angular_components.xy, turn), pair_turned(angular_components.zw, thrice));
}

void main() {
    const uint thread = linear_thread();
    if (thread >= parameters.vertices) return;
    const uint vertex = parameters.first + thread;

    const TangentFrame frame = frame_of_normal(texelFetch(normals, int(vertex)).xyz);
    const vec3 e1 = texelFetch(first, int(vertex)).xyz;
    const vec4 derivative = derivative_of_angular_components(diffused_angular_components(vertex, frame.normal));
    derivatives[vertex] = parameters.scale * parameters.scale *
                          in_rotated_frame(derivative, vec2(dot(e1, frame.tangent), dot(e1, frame.bitangent)));
}
