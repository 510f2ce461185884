// Reads segments of lines (shared::LineSegmentRecord), two texels each. The including shader declares `segments`.
#ifndef EXEMPLAR_SEGMENTS_GLSL
#define EXEMPLAR_SEGMENTS_GLSL
#include "shaders/shared/lines.h"

LineSegmentRecord segment_at(uint index) {
    const uvec4 head = texelFetch(segments, int(2u * index)), ends = texelFetch(segments, int(2u * index + 1u));
    return LineSegmentRecord(head.x, head.y, uintBitsToFloat(head.z), uintBitsToFloat(head.w), uintBitsToFloat(ends));
}

uint family_of(LineSegmentRecord segment) {
    return segment.kind & k_kind_family;
}
uint place_of(uint kind, uint end) {
    return kind >> (end == 0u ? k_kind_first_place : k_kind_second_place) & k_kind_place;
}
// Returns the barycentric coordinates of an end.
vec3 end_of(LineSegmentRecord segment, uint end) {
    const vec2 of_others = end == 0u ? segment.ends.xy : segment.ends.zw;
    return vec3(1.0 - of_others.x - of_others.y, of_others);
}

#endif
