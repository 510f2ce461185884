#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/srgb.glsl"
#include "shaders/shared/render.h"

// Averages each pixel's samples in linear color and encodes the mean as sRGB.
layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Push { ResolveParameters parameters; };
layout(set = 0, binding = 0, std430) readonly buffer Samples { uvec2 samples[]; };  // half floats: red, green, blue, 1
layout(set = 0, binding = 1, std430) writeonly buffer Pixels { uint pixels[]; };    // 8 bits per channel, red lowest

vec3 linear_sample(uint column, uint row) {
    const uvec2 packed = samples[row * k_render_samples * parameters.width + column];
    return vec3(unpackHalf2x16(packed.x), unpackHalf2x16(packed.y).x);
}

void main() {
    const uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= parameters.width || pixel.y >= parameters.height) return;
    vec3 sum = vec3(0.0);
    for (uint y = 0; y < k_render_samples; ++y)
        for (uint x = 0; x < k_render_samples; ++x)
            sum += linear_sample(pixel.x * k_render_samples + x, pixel.y * k_render_samples + y);
    const vec3 mean = sum / float(k_render_samples * k_render_samples);
    pixels[pixel.y * parameters.width + pixel.x] = packUnorm4x8(vec4(linear_to_srgb(mean), 1.0));
}
