// Looks up the segments of a face. The including shader declares `face_counts` and `groups` (count.comp, scan.comp).
#ifndef EXEMPLAR_FACE_SEGMENTS_GLSL
#define EXEMPLAR_FACE_SEGMENTS_GLSL
#include "shaders/shared/lines.h"

// Returns the range [x, y) of the segments of a face, clamped to `all`, the number of segments.
uvec2 segments_of(uint face, uint all) {
    const uint count = texelFetch(face_counts, int(face)).x;
    const uint first = texelFetch(groups, int(face / k_count_group)).x + (count >> 8);
    return min(uvec2(first, first + (count & 0xffu)), uvec2(all));
}

#endif
