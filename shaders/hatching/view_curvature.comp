#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/lib/eye.glsl"
#include "shaders/lib/view_curvature.glsl"
#include "shaders/shared/hatching_features.h"

// Features of surface and view at one scale (host/hatching/features/hatching_view.cpp), and their magnitudes,
// written to their lanes of a slab. One vertex per invocation. Reads 80 bytes and writes 4 per lane.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { ViewCurvatureParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer states;                      // vertices x k_curvature_texels
layout(set = 0, binding = 1, std430) writeonly buffer Slab { float slab[]; };   // vertices x k_slab_lanes

// Returns the derivative of radial curvature along the projection of w, times the sine between w and the normal
// (host/lines/extraction/view_curvature.cpp). `squared_sine` is the squared length of uv, not zero.
float radial_derivative(vec2 k, vec4 d, vec2 uv, float squared_sine, float cosine) {
    const float third = uv.x * uv.x * (uv.x * d.x + 3.0 * uv.y * d.y) + uv.y * uv.y * (3.0 * uv.x * d.z + uv.y * d.w);
    const float torsion = (k.y - k.x) * uv.x * uv.y / squared_sine;
    return third / squared_sine - 2.0 * cosine * torsion * torsion;
}

void main() {
    const uint vertex = linear_thread();
    if (vertex >= parameters.vertices) return;

    const int state = int(vertex * k_curvature_texels), scaled = state + 2 + 3 * int(parameters.scale);
    const vec3 normal = texelFetch(states, state + 1).xyz;
    const vec3 w = to_eye(parameters.eye, texelFetch(states, state).xyz);
    const vec4 e1 = texelFetch(states, scaled), e2 = texelFetch(states, scaled + 1), d = texelFetch(states, scaled + 2);
    const vec2 k = vec2(e1.w, e2.w), uv = vec2(dot(e1.xyz, w), dot(e2.xyz, w));
    const float cosine = dot(normal, w), own = dot(uv, uv), squared_sine = max(own, 1e-6);
    const float largest = view_curvature(k, uv, cosine).x;
    const bool first_is_large = abs(k.x) >= abs(k.y);
    const float along = own > 0.0 ? radial_derivative(k, d, uv, own, cosine) * inversesqrt(squared_sine) : 0.0;

    const float limit = parameters.limit, square = limit * limit;
    const vec4 first = clamp(vec4(k, first_is_large ? k : k.yx), -limit, limit);
    const vec4 derivative = clamp(d, -square, square);
    const vec4 seen = clamp(vec4(dot(k, uv * uv) / squared_sine, sqrt(largest),
                                 sqrt(min_view_curvature(k, largest, cosine)),
                                 (k.y - k.x) * uv.x * uv.y / squared_sine), -limit, limit);
    const float values[k_curvature_values] = float[](clamp(0.5 * (k.x + k.y), -limit, limit), clamp(k.x * k.y, -square, square),
                                     first.x, first.y, first.z, first.w,
                                     derivative.x, derivative.y, derivative.z, derivative.w,
                                     seen.x, clamp(along, -square, square), seen.y, seen.z, seen.w);
    for (uint lane = 0; lane < k_slab_lanes; ++lane) {
        const uint column = bitfieldExtract(parameters.columns[lane / 4], int(8 * (lane % 4)), 8);
        if (column == k_other_scale) continue;
        const float value = values[column / 2];
        slab[vertex * k_slab_lanes + lane] = column % 2 == 0 ? value : abs(value);
    }
}
