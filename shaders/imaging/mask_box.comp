#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/image_filters.h"

// Computes the smallest rectangle around the pixels that show a face, one row per invocation.
layout(local_size_x = 64, local_size_x_id = 100) in;
layout(push_constant) uniform Push { ImageParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer faces;
layout(set = 0, binding = 1, std430) buffer Box { uint box[]; };  // left, top, right, bottom; the latter two are
                                                                  // exclusive

void main() {
    const uint y = gl_GlobalInvocationID.x;
    if (y >= parameters.height) return;
    uint left = parameters.width, end = 0;
    for (uint x = 0; x < parameters.width; ++x) {
        if (texelFetch(faces, int(y * parameters.width + x)).x == k_filter_no_face) continue;
        left = min(left, x);
        end = x + 1;
    }
    if (end == 0) return;
    atomicMin(box[0], left);
    atomicMin(box[1], y);
    atomicMax(box[2], end);
    atomicMax(box[3], y + 1);
}
