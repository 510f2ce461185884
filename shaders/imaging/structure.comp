#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/imaging/image_box.glsl"

// Computes the structure tensors of single pixels, in terms of the doubled angle of their gradients.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { ImageParameters image; };
layout(set = 0, binding = 0) uniform samplerBuffer gradients;  // 2 x images x pixels: all x, all y
// Planes of the box.
layout(set = 0, binding = 1, std430) writeonly buffer Trace { vec4 trace[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Difference { vec4 difference[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Product { vec4 product[]; };

void main() {
    const uvec2 at = pixel_of_box(image, gl_GlobalInvocationID.xy);
    if (!in_box(image, at)) return;
    const uint pixel = pixel_index(image, at), pixels = pixel_count(image), place = box_index(image, at);
    vec4 x = vec4(0.0), y = vec4(0.0);
    [[unroll]] for (uint i = 0; i < k_filter_images; ++i) {
        if (i >= image.images) break;
        x[i] = texelFetch(gradients, int(i * pixels + pixel)).x;
        y[i] = texelFetch(gradients, int((image.images + i) * pixels + pixel)).x;
    }
    trace[place] = x * x + y * y;
    difference[place] = x * x - y * y;
    product[place] = 2.0 * x * y;
}
