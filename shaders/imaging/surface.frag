#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/eye.glsl"
#include "shaders/imaging/light.glsl"
#include "shaders/lib/srgb.glsl"
#include "shaders/shared/paint.h"

// Paints and lights a two-sided surface.
layout(constant_id = 0) const uint k_paint = 0;
layout(constant_id = 1) const uint k_light = 0;
layout(push_constant) uniform Push { PaintParameters parameters; };

layout(location = 0) in vec4 place;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 color;
layout(location = 0) out vec4 drawn;  // sRGB, multiplied by its alpha

const float k_ambient = 0.42, k_ground = 0.35, k_headlight = 0.62;  // of exemplar::RenderOptions

// Concave is blue, flat nearly white, convex red; linear colors.
vec3 curvature_color(float strength) {
    const float x = clamp(strength, -1.0, 1.0);
    const vec3 flat_color = vec3(0.80), far = x < 0.0 ? vec3(0.03, 0.16, 0.55) : vec3(0.62, 0.04, 0.03);
    return mix(flat_color, far, abs(x));
}

vec3 paint() {
    if (k_paint == k_paint_plain) return parameters.plain.rgb;
    if (k_paint == k_paint_faces) return color;
    return linear_to_srgb(k_paint == k_paint_normals ? clamp(0.5 + 0.5 * normal, 0.0, 1.0) : curvature_color(place.w));
}

vec3 face_normal() {
    return cross(normalize(dFdx(place.xyz)), normalize(dFdy(place.xyz)));
}

vec3 lit(vec3 encoded) {
    if (k_light == k_light_none) return encoded;
    const vec3 toward = to_eye(parameters.eye, place.xyz);
    const vec3 n = unit_normal(k_light == k_light_flat ? face_normal() : normal);
    const float facing = abs(dot(n, toward));
    if (k_light == k_light_headlight) return encoded * (0.45 + 0.55 * facing);
    if (k_light == k_light_steps) return encoded * (facing > 0.55 ? 1.0 : facing > 0.25 ? 0.86 : 0.72);
    // Approximates the encoded product of linear color and light. Equal to it except near black, and needs one power
    // instead of six.
    const float light = reference_light(n, toward, k_ambient, k_ground, k_headlight);
    return (encoded + 0.055) * pow(light, 1.0 / 2.4) - 0.055;
}

void main() {
    const float alpha = parameters.plain.a;
    drawn = vec4(lit(paint()) * alpha, alpha);
}
