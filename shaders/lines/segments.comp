#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lines/line_buffers.glsl"

// Writes the segments of each face at their positions. One face per invocation: reads 4 bytes, for faces with lines
// also what count.comp reads, and writes 32 per segment.
layout(set = 0, binding = 6, std430) readonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 7, std430) readonly buffer Groups { uint groups[]; };  // number before each group
layout(set = 0, binding = 8, std430) readonly buffer Slots { uint slots_of_faces[]; };  // count.comp
layout(set = 0, binding = 9, std430) writeonly buffer Segments { LineSegmentRecord segments[]; };

// Slots of the face that have a segment, and those whose segment is not written yet.
uint this_face, first_segment, slots, missing;
#define if_wanted(these) if ((slots & (these)) != 0u)
void write_segment(uint slot, LineSegmentRecord segment) {
    const uint place = first_segment + bitCount(slots & (1u << slot) - 1u);
    if (place < parameters.max_segments) segments[place] = segment;
    missing &= ~(1u << slot);
}
void emit(uint slot, uint family, uint first_place, uint second_place, vec3 first_end, vec3 second_end, vec2 strength) {
    if ((missing & 1u << slot) == 0u) return;
    write_segment(slot, LineSegmentRecord(
                            this_face, family | first_place << k_kind_first_place | second_place << k_kind_second_place,
                            strength.x, strength.y, vec4(first_end.yz, second_end.yz)));
}
#include "shaders/lines/face_lines.glsl"

void main() {
    this_face = linear_thread();
    if (this_face >= parameters.faces) return;
    slots = missing = slots_of_faces[this_face];
    if (slots != 0u) {
        first_segment = groups[this_face / k_count_group] + (counts[this_face] >> 8);
        find_lines(this_face);
    }
    // A compiler may round here otherwise than in count.comp. A segment found only there becomes a point.
    const uint nowhere = k_place_inside << k_kind_first_place | k_place_inside << k_kind_second_place;
    while (missing != 0u)
        write_segment(uint(findLSB(missing)), LineSegmentRecord(this_face, k_contours | nowhere, 0.0, 0.0, vec4(0.0)));
}
