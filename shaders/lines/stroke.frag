#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/lines.h"

// Computes the coverage of a pixel by the visible part of a stroke, times its texture.
layout(set = 0, binding = 4) uniform samplerBuffer textures;  // rows of opacities, one texture after the other

layout(location = 0) in vec4 along;
layout(location = 1) in float texture_at;
layout(location = 2) flat in uvec3 seen;
layout(location = 3) flat in vec4 color;
layout(location = 4) flat in vec2 texture_of;
layout(location = 0) out vec4 drawn;

float texel(uint begin, int column, int row) {
    return texelFetch(textures, int(begin) + row * int(k_texture_width) + column).x;
}

// Interpolates bilinearly, repeated along the stroke and clamped across it.
float opacity_at(uint begin, float turn, float across) {
    const vec2 at = vec2(fract(turn) * float(k_texture_width), clamp(across, 0.0, 1.0) * float(k_texture_height)) - 0.5;
    const vec2 low = floor(at), part = at - low;
    const int left = int(low.x) < 0 ? int(k_texture_width) - 1 : int(low.x);
    const int right = left + 1 == int(k_texture_width) ? 0 : left + 1;
    const int top = clamp(int(low.y), 0, int(k_texture_height) - 1), bottom = clamp(int(low.y) + 1, 0, int(k_texture_height) - 1);
    return mix(mix(texel(begin, left, top), texel(begin, right, top), part.x),
               mix(texel(begin, left, bottom), texel(begin, right, bottom), part.x), part.y);
}

void main() {
    const uint sample_index = min(uint(along.w * float(seen.y)), seen.y - 1u);
    if ((seen.x >> sample_index & 1u) == 0u) discard;
    const float half_width = along.y;
    // The share of the pixel's width that the stroke covers.
    const float covered = min(half_width, along.x + 0.5) - max(-half_width, along.x - 0.5);
    float alpha = along.z * max(covered, 0.0);
    if (seen.z != 0u)
        alpha *= opacity_at(seen.z - 1u, texture_at / texture_of.x,
                            0.5 + 0.5 * texture_of.y * along.x / max(half_width, 0.5));
    drawn = vec4(color.rgb * alpha, alpha);
}
