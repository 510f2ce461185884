#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/curvature/face_fit.glsl"
#include "shaders/curvature/surface.glsl"

// Computes derivatives of curvature in the principal frames from the forms at the corners of the faces around each
// vertex, like curvature.comp. Per vertex with six faces 4 + 32 bytes of topology and 48 of position and principal
// frame are read and 16 written, each once; the data of its seven ring entries comes from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const bool k_smoothed = false;
layout(set = 0, binding = 3) uniform samplerBuffer first;    // e1, k1
layout(set = 0, binding = 4) uniform samplerBuffer second;   // e2, k2
layout(set = 0, binding = 5) uniform samplerBuffer normals;  // for smoothing
// If smoothed, to_angular_components of the derivatives in frame_of_normal(normal), in scaled units.
layout(set = 0, binding = 6, std430) writeonly buffer Derivatives { vec4 derivatives[]; };

struct Principal {
    vec3 axis;
    vec3 normal;
    vec2 k;  // in units in which edges are about 1 long
};

Principal principal_of(uint vertex) {
    const vec4 one = texelFetch(first, int(vertex)), two = texelFetch(second, int(vertex));
    return Principal(one.xyz, cross(one.xyz, two.xyz), vec2(one.w, two.w) / parameters.scale);
}

// Returns the form with principal curvatures k, in a frame from which its principal frame is rotated by `turn`.
vec3 form_of(vec2 k, vec2 turn) {
    return in_rotated_frame(vec3(k.x, 0.0, k.y), vec2(turn.x, -turn.y));
}

vec3 form_in(TangentFrame frame, Principal principal) {
    return form_of(principal.k, rotation_to(frame, principal.axis, principal.normal));
}

// Returns the area-weighted mean of the derivatives of the faces around a vertex, in its principal frame; zero
// without faces.
vec4 mean_derivative(uint vertex) {
    const vec3 here = position_of(vertex);
    const Principal own = principal_of(vertex);
    vec4 sum = vec4(0.0);
    vec3 last = here;
    Principal last_principal = own;
    float area = 0.0;
    uint texel = texelFetch(ring_begin, int(vertex)).x;
    for (bool more = true; more; ++texel) {
        uvec4 entries = texelFetch(rings, int(texel));
        for (uint i = 0; i < 4 && more; ++i) {
            const uint corner = entries.x & k_ring_vertex;
            const vec3 there = position_of(corner);
            const Principal principal = principal_of(corner);
            const FaceFit fit = measure_face(parameters.scale * (last - here), parameters.scale * (there - here),
                                             parameters.scale * (there - last));
            if ((entries.x & k_ring_fan) == 0 && fit.area > 0.0) {
                const vec2 turn = rotation_to(fit.frame, own.axis, own.normal);
                const vec3 form = form_of(own.k, turn);
                const vec4 derivative =
                    fit_derivative(fit, form_in(fit.frame, last_principal) - form, form_in(fit.frame, principal) - form);
                sum += fit.area * in_rotated_frame(derivative, turn);
                area += fit.area;
            }
            last = there;
            last_principal = principal;
            more = (entries.x & k_ring_last) == 0;
            entries = entries.yzwx;
        }
    }
    return area > 0.0 ? sum / area : vec4(0.0);
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;
    const vec4 derivative = mean_derivative(vertex);
    if (!k_smoothed) {
        derivatives[vertex] = parameters.scale * parameters.scale * derivative;
        return;
    }
    // From the principal frame to frame_of_normal.
    const TangentFrame frame = frame_of_normal(texelFetch(normals, int(vertex)).xyz);
    const vec3 e1 = texelFetch(first, int(vertex)).xyz;
    derivatives[vertex] = to_angular_components(in_rotated_frame(derivative, vec2(dot(e1, frame.tangent), -dot(e1, frame.bitangent))));
}
