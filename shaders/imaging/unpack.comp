#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/imaging/image_box.glsl"

// Unpacks whole images from the lanes of a vec4 per pixel into one image after the other.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { ImageParameters image; };
layout(set = 0, binding = 0) uniform samplerBuffer packed;                         // pixels
layout(set = 0, binding = 1, std430) writeonly buffer Values { float values[]; };  // images x pixels

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (!in_image(image, at)) return;
    const uint pixel = pixel_index(image, at);
    const vec4 here = texelFetch(packed, int(pixel));
    [[unroll]] for (uint i = 0; i < k_filter_images; ++i)
        if (i < image.images) values[i * pixel_count(image) + pixel] = here[i];
}
