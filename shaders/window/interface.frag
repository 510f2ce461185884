#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/window.h"

// Draws text and shapes of the interface: the color, with the opacity of the atlas. Or a part of the pictures, opaque.
layout(push_constant) uniform Push { InterfaceParameters parameters; };
// Per texel (x, y) the opacities at (x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1), a byte each: all that is needed
// to interpolate between their centers.
layout(set = 0, binding = 2) uniform usamplerBuffer atlas;
layout(set = 0, binding = 3, std430) readonly buffer Pictures { uint pictures[]; };  // RGBA, red lowest, row by row

layout(location = 0) in vec2 place;
layout(location = 1) in vec4 color;
layout(location = 0) out vec4 premultiplied;

float opacity() {
    // Most of an interface is uniform areas.
    if (all(lessThan(abs(place - parameters.white), vec2(1e-6)))) return 1.0;
    const vec2 size = vec2(parameters.atlas_width, parameters.atlas_height);
    const vec2 at = clamp(place * size - 0.5, vec2(0.0), size - 1.0);
    const uvec2 texel = uvec2(at);
    const vec4 around = unpackUnorm4x8(texelFetch(atlas, int(texel.y * parameters.atlas_width + texel.x)).x);
    const vec2 part = fract(at);
    return mix(mix(around.x, around.y, part.x), mix(around.z, around.w, part.x), part.y);
}

vec3 picture() {
    const uvec2 size = uvec2(parameters.picture_width, parameters.picture_height);
    const uvec2 texel = min(uvec2(max(place, vec2(0.0)) * vec2(size)), size - 1);
    return unpackUnorm4x8(pictures[texel.y * size.x + texel.x]).rgb;
}

void main() {
    if (parameters.picture_width > 0) {
        premultiplied = vec4(picture() * color.rgb, 1.0);
        return;
    }
    const float alpha = color.a * opacity();
    premultiplied = vec4(color.rgb * alpha, alpha);
}
