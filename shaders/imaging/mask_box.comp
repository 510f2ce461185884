#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/image_filters.h"

// Computes the smallest rectangle around the pixels that show a face. An invocation reads parameters.rows pixels of a column;
// a workgroup combines those of its invocations in shared memory, and widens the rectangle once.
layout(local_size_x = 64) in;
layout(push_constant) uniform Push { ImageParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer faces;
layout(set = 0, binding = 1, std430) buffer Box { uint box[]; };  // left, top, right, bottom; the latter two are
                                                                  // exclusive
shared uint of_group[4];  // the same

void main() {
    const uint x = gl_GlobalInvocationID.x, first = parameters.rows * gl_GlobalInvocationID.y;
    if (gl_LocalInvocationID.x < 4) of_group[gl_LocalInvocationID.x] = gl_LocalInvocationID.x < 2 ? 0xffffffffu : 0;
    uint top = parameters.height, bottom = 0;
    const uint end = x < parameters.width ? min(first + parameters.rows, parameters.height) : first;
    for (uint y = first; y < end; ++y) {
        if (texelFetch(faces, int(y * parameters.width + x)).x == k_filter_no_face) continue;
        top = min(top, y);
        bottom = y + 1;
    }
    barrier();
    if (bottom > 0) {
        atomicMin(of_group[0], x);
        atomicMin(of_group[1], top);
        atomicMax(of_group[2], x + 1);
        atomicMax(of_group[3], bottom);
    }
    barrier();
    if (gl_LocalInvocationID.x != 0 || of_group[3] == 0) return;
    atomicMin(box[0], of_group[0]);
    atomicMin(box[1], of_group[1]);
    atomicMax(box[2], of_group[2]);
    atomicMax(box[3], of_group[3]);
}
