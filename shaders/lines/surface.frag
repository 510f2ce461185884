#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/lines.h"

// Paper, shaded smoothly or in steps by a light beside the eye, on both sides of the surface.
layout(push_constant) uniform Push { SurfaceDrawParameters parameters; };
layout(location = 0) in vec3 to_eye;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 color;
layout(location = 0) out vec4 drawn;

void main() {
    float light = 1.0;
    if (parameters.paper.w != 0.0) {
        const float facing = abs(dot(normalize(to_eye), normal * inversesqrt(max(dot(normal, normal), 1e-30))));
        light = parameters.paper.w == 1.0 ? 0.45 + 0.55 * facing : facing > 0.55 ? 1.0 : facing > 0.25 ? 0.86 : 0.72;
    }
    // As strokes are blended over it: multiplied by its alpha.
    const float alpha = parameters.coloring == 0u ? parameters.alpha : 1.0;
    drawn = vec4(color * light * alpha, alpha);
}
