#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/curvature/face_fit.glsl"
#include "shaders/curvature/surface.glsl"

// Computes principal curvatures and directions (exemplar::estimate_curvature), one vertex per invocation. Each fits
// the faces around it again: three times the arithmetic of a pass over faces, but no data of faces is written or
// read, and two passes are saved. Per vertex with six faces 4 + 32 bytes of topology and 32 of position and normal
// are read and 32 written, each once; the data of its seven ring entries comes from caches.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const bool k_smoothed = false;
layout(set = 0, binding = 3) uniform samplerBuffer normals;
// If smoothed, `first` has to_angular_components of the form in scaled units instead.
layout(set = 0, binding = 4, std430) writeonly buffer First { vec4 first[]; };    // e1, k1
layout(set = 0, binding = 5, std430) writeonly buffer Second { vec4 second[]; };  // e2, k2

vec3 normal_of(uint vertex) {
    return texelFetch(normals, int(vertex)).xyz;
}

// Returns the area-weighted mean of the forms of the faces around a vertex, in its frame; zero without faces.
vec3 mean_form(uint vertex, TangentFrame frame) {
    const vec3 here = position_of(vertex);
    vec3 sum = vec3(0.0), last = vec3(0.0), last_normal = vec3(0.0);
    float area = 0.0;
    uint texel = texelFetch(ring_begin, int(vertex)).x;
    for (bool more = true; more; ++texel) {
        uvec4 entries = texelFetch(rings, int(texel));
        for (uint i = 0; i < 4 && more; ++i) {
            const uint corner = entries.x & k_ring_vertex;
            const vec3 there = position_of(corner), normal = normal_of(corner);
            const FaceFit fit = measure_face(parameters.scale * (last - here), parameters.scale * (there - here),
                                             parameters.scale * (there - last));
            if ((entries.x & k_ring_fan) == 0 && fit.area > 0.0) {
                const vec3 form = fit_form(fit, last_normal - frame.normal, normal - frame.normal);
                sum += fit.area * in_rotated_frame(form, rotation_to(fit.frame, frame.tangent, frame.normal));
                area += fit.area;
            }
            last = there;
            last_normal = normal;
            more = (entries.x & k_ring_last) == 0;
            entries = entries.yzwx;
        }
    }
    return area > 0.0 ? sum / area : vec3(0.0);
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const TangentFrame frame = frame_of_normal(normal_of(vertex));
    const vec3 form = mean_form(vertex, frame);
    if (k_smoothed) {
        first[vertex] = to_angular_components(form);
        return;
    }
    vec2 k;
    const vec2 turn = principal_rotation(form, k);
    first[vertex] = vec4(turn.x * frame.tangent + turn.y * frame.bitangent, parameters.scale * k.x);
    second[vertex] = vec4(turn.x * frame.bitangent - turn.y * frame.tangent, parameters.scale * k.y);
}
