#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/srgb.glsl"
#include "shaders/shared/window.h"

// The light of exemplar::RenderOptions on a two-sided surface, in linear color.
layout(push_constant) uniform Push { PaintParameters parameters; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 color;
layout(location = 3) in float curvature;
layout(location = 0) out vec4 encoded;

const float k_ambient = 0.42, k_ground = 0.35, k_headlight = 0.62;

// Hollow is blue, flat is nearly white, convex is red.
vec3 curvature_color(float strength) {
    const float x = clamp(strength, -1.0, 1.0);
    const vec3 flat_color = vec3(0.80), far = x < 0.0 ? vec3(0.03, 0.16, 0.55) : vec3(0.62, 0.04, 0.03);
    return mix(flat_color, far, abs(x));
}

vec3 turned_normal(vec3 to_eye) {
    vec3 given = normal;
    if (parameters.light == k_light_flat) given = cross(normalize(dFdx(position)), normalize(dFdy(position)));
    // Normals that cancel out are left without direction, not made NaN.
    const vec3 n = given * inversesqrt(max(dot(given, given), 1e-30));
    return dot(n, to_eye) < 0.0 ? -n : n;
}

void main() {
    const vec3 to_eye = normalize(parameters.eye.xyz - parameters.eye.w * position);
    const vec3 n = turned_normal(to_eye);
    vec3 painted = color;
    if (parameters.paint == k_paint_normals)
        painted = 0.5 + 0.5 * normal;
    else if (parameters.paint >= k_paint_mean)
        painted = curvature_color(curvature);
    const float facing = max(dot(n, to_eye), 0.0);
    const float hemisphere = mix(k_ground, 1.0, (1.0 + n.y) / 2.0);
    float light = k_ambient * hemisphere + k_headlight * facing;
    if (parameters.light == k_light_none) light = 1.0;
    if (parameters.light == k_light_steps) light = facing > 0.55 ? 1.0 : facing > 0.25 ? 0.7 : 0.48;
    encoded = vec4(linear_to_srgb(min(painted * light, 1.0)), 1.0);
}
