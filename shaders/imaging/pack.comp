#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/imaging/image_box.glsl"

// Packs up to four images into the lanes of one vec4 per pixel of the box, zero outside of the mask.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(constant_id = 0) const bool k_masked = true;
layout(push_constant) uniform Push { ImageParameters image; };
layout(set = 0, binding = 0) uniform samplerBuffer values;                          // images x pixels
layout(set = 0, binding = 1) uniform usamplerBuffer faces;                          // pixels
layout(set = 0, binding = 2, std430) writeonly buffer Packed { vec4 packed[]; };    // the box
layout(set = 0, binding = 3, std430) writeonly buffer Inside { float inside[]; };   // the box: 1 or 0

void main() {
    const uvec2 at = pixel_of_box(image, gl_GlobalInvocationID.xy);
    if (!in_box(image, at)) return;
    const uint pixel = pixel_index(image, at), place = box_index(image, at);
    const bool shown = !k_masked || texelFetch(faces, int(pixel)).x != k_filter_no_face;
    vec4 here = vec4(0.0);
    if (shown)
        [[unroll]] for (uint i = 0; i < k_filter_images; ++i)
            if (i < image.images) here[i] = texelFetch(values, int(i * pixel_count(image) + pixel)).x;
    packed[place] = here;
    if (k_masked) inside[place] = shown ? 1.0 : 0.0;
}
