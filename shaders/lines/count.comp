#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lines/line_buffers.glsl"

// Counts the segments of each face, so that segments.comp can write them in the order of the faces. One face per
// invocation: reads 16 bytes and the fields of its corners (48 per family, from caches), writes 4, and 4 per group.
// Per face: the number of segments before it in its group << 8 | its own.
layout(set = 0, binding = 6, std430) writeonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Groups { uint groups[]; };

uint found = 0;
void emit(uint family, uint first_place, uint second_place, vec3 first_end, vec3 second_end, vec2 strength) {
    ++found;
}
#include "shaders/lines/face_lines.glsl"
#include "shaders/lib/group_sum.glsl"

void main() {
    const uint face = linear_thread();
    if (face < parameters.faces) find_lines(face);
    const uint before = exclusive_sum(found);
    if (face < parameters.faces) counts[face] = before << 8 | found;
    if (gl_LocalInvocationID.x == 0u && face < parameters.faces) groups[face / k_count_group] = group_total;
}
