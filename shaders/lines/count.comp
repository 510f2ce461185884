#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lines/line_buffers.glsl"

// Counts the segments of each face, so that segments.comp can write them in the order of the faces, and decides which
// segments there are. One face per invocation: reads 16 bytes and the fields of its corners (48 per family, from
// caches), writes 8, and 4 per group.
// Per face: the number of segments before it in its group << 8 | its own.
layout(set = 0, binding = 6, std430) writeonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 7, std430) writeonly buffer Groups { uint groups[]; };
layout(set = 0, binding = 8, std430) writeonly buffer Slots { uint slots_of_faces[]; };  // a bit per segment

uint found = 0;
#define if_wanted(slots)
void emit(uint slot, uint family, uint first_place, uint second_place, vec3 first_end, vec3 second_end, vec2 strength) {
    found |= 1u << slot;
}
#include "shaders/lines/face_lines.glsl"
#include "shaders/lib/group_sum.glsl"

void main() {
    const uint face = linear_thread();
    if (face < parameters.faces) find_lines(face);
    const uint own = bitCount(found), before = exclusive_sum(own);
    if (face >= parameters.faces) return;
    counts[face] = before << 8 | own;
    slots_of_faces[face] = found;
    if (gl_LocalInvocationID.x == 0u) groups[face / k_count_group] = group_total;
}
