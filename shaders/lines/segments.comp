#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lines/line_buffers.glsl"

// Writes the segments of each face at their positions. One face per invocation: reads 4 bytes, for faces with lines
// also what count.comp reads, and writes 32 per segment.
layout(set = 0, binding = 6, std430) readonly buffer Counts { uint counts[]; };
layout(set = 0, binding = 7, std430) readonly buffer Groups { uint groups[]; };  // number before each group
layout(set = 0, binding = 8, std430) writeonly buffer Segments { LineSegmentRecord segments[]; };

uint this_face, next_segment;
void emit(uint family, uint first_place, uint second_place, vec3 first_end, vec3 second_end, vec2 strength) {
    if (next_segment < parameters.max_segments)
        segments[next_segment] = LineSegmentRecord(
            this_face, family | first_place << k_kind_first_place | second_place << k_kind_second_place, strength.x,
            strength.y, vec4(first_end.yz, second_end.yz));
    ++next_segment;
}
#include "shaders/lines/face_lines.glsl"

void main() {
    this_face = linear_thread();
    if (this_face >= parameters.faces) return;
    const uint count = counts[this_face];
    when ((count & 0xffu) != 0u) {
        next_segment = groups[this_face / k_count_group] + (count >> 8);
        find_lines(this_face);
    }
}
