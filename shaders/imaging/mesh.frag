#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/eye.glsl"
#include "shaders/imaging/light.glsl"
#include "shaders/shared/render.h"

// Lights a two-sided surface by hemisphere light and headlight, in linear color (exemplar::RenderOptions has the
// formula).
layout(push_constant) uniform Push { RenderParameters parameters; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) flat in vec3 color;
layout(location = 0) out vec4 lit;

void main() {
    const float light = reference_light(unit_normal(normal), to_eye(parameters.eye, position), parameters.ambient,
                                        parameters.ground, parameters.headlight);
    lit = vec4(min(color * light, 1.0), 1.0);
}
