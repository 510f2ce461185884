#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/render.h"

// Hemisphere light and headlight on a two-sided surface, in linear color (exemplar::RenderOptions has the formula).
layout(push_constant) uniform Push { RenderParameters parameters; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 color;
layout(location = 0) out vec4 lit;

void main() {
    const vec3 to_eye = normalize(parameters.eye.xyz - parameters.eye.w * position);
    // Normals that cancel out are left without direction, not made NaN.
    vec3 n = normal * inversesqrt(max(dot(normal, normal), 1e-30));
    float facing = dot(n, to_eye);
    if (facing < 0.0) {
        n = -n;
        facing = -facing;
    }
    const float hemisphere = mix(parameters.ground, 1.0, (1.0 + n.y) / 2.0);
    const float light = parameters.ambient * hemisphere + parameters.headlight * facing;
    lit = vec4(min(color * light, 1.0), 1.0);
}
