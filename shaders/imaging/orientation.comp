#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/imaging/image_box.glsl"

// Computes coherence (cos 2a, sin 2a) from smoothed structure tensors.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { OrientationParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer trace;  // planes of the box
layout(set = 0, binding = 1) uniform samplerBuffer difference;
layout(set = 0, binding = 2) uniform samplerBuffer product;
layout(set = 0, binding = 3) uniform usamplerBuffer faces;
layout(set = 0, binding = 4, std430) writeonly buffer Orientations { float orientations[]; };  // all cos, all sin

void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    const ImageParameters image = parameters.image;
    if (!in_image(image, at)) return;
    const uint pixel = pixel_index(image, at), pixels = pixel_count(image);
    vec4 cosine = vec4(0.0), sine = vec4(0.0);
    if (in_box(image, at) && texelFetch(faces, int(pixel)).x != k_filter_no_face) {
        const int place = int(box_index(image, at));
        const vec4 scale = 1.0 / (texelFetch(trace, place) + parameters.noise);
        cosine = scale * texelFetch(difference, place);
        sine = scale * texelFetch(product, place);
    }
    [[unroll]] for (uint i = 0; i < k_filter_images; ++i) {
        if (i >= image.images) break;
        orientations[i * pixels + pixel] = cosine[i];
        orientations[(image.images + i) * pixels + pixel] = sine[i];
    }
}
