#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Projects the ends of segments into the picture and finds the ends that continue them
// (host/lines/strokes/chains.cpp). One segment per invocation: reads 32 bytes and, from caches, its face, the face's
// neighbors and their segments; writes 32 + 8.
layout(local_size_x = k_count_group) in;
layout(push_constant) uniform Push { LinkParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer positions;
layout(set = 0, binding = 1) uniform usamplerBuffer faces;
layout(set = 0, binding = 2) uniform usamplerBuffer joined_faces;  // before the surface was cut open
layout(set = 0, binding = 3) uniform usamplerBuffer neighbors;
layout(set = 0, binding = 4) uniform usamplerBuffer face_begin;  // per vertex of the joined faces and one more
layout(set = 0, binding = 5) uniform usamplerBuffer vertex_faces;
layout(set = 0, binding = 6) uniform usamplerBuffer face_counts;
layout(set = 0, binding = 7) uniform usamplerBuffer groups;
layout(set = 0, binding = 8) uniform usamplerBuffer segments;
layout(set = 0, binding = 9, std430) readonly buffer Counts { LineCounts counts; };
// Two per segment: pixels, depth, view depth.
layout(set = 0, binding = 10, std430) writeonly buffer Ends { vec4 picture_ends[]; };
layout(set = 0, binding = 11, std430) writeonly buffer Links { uvec2 links[]; };
#include "shaders/lines/face_segments.glsl"
#include "shaders/lines/in_picture.glsl"
#include "shaders/lines/segments.glsl"

uint link_across(LineSegmentRecord segment, uint side) {
    const uint across = texelFetch(neighbors, int(segment.face))[side];
    // Contours end at sharp edges, where they are not where the other side has them.
    const uint stops = k_crowded_side | (family_of(segment) == k_contours ? k_sharp_side : 0u);
    if (across >= k_blocked_side || (across & stops) != 0u) return k_no_link;
    const uint code = across & k_max_side_code;
    const uvec2 others = segments_of(code / 4u, counts.segments);
    for (uint i = others.x; i < others.y; ++i) {
        const uint kind = texelFetch(segments, int(2u * i)).y;
        if ((kind & k_kind_family) != family_of(segment)) continue;
        for (uint end = 0; end < 2; ++end)
            if (place_of(kind, end) == code % 4u) return 2u * i + end;
    }
    return k_no_link;
}

// Returns the other end at a vertex if there is exactly one.
uint link_at(LineSegmentRecord segment, uint self, uint vertex) {
    uint found = k_no_link, ends = 0;
    const uint last = texelFetch(face_begin, int(vertex + 1u)).x;
    for (uint at = texelFetch(face_begin, int(vertex)).x; at < last; ++at) {
        const uint face = texelFetch(vertex_faces, int(at)).x;
        const uvec2 others = segments_of(face, counts.segments);
        for (uint i = others.x; i < others.y; ++i) {
            const uint kind = texelFetch(segments, int(2u * i)).y;
            if ((kind & k_kind_family) != family_of(segment)) continue;
            for (uint end = 0; end < 2; ++end) {
                const uint place = place_of(kind, end);
                if (place == k_place_inside || texelFetch(joined_faces, int(face))[place - k_place_corner] != vertex) continue;
                ++ends;
                if (2u * i + end != self) found = 2u * i + end;
            }
        }
    }
    return ends == 2u ? found : k_no_link;
}

uint link_of(LineSegmentRecord segment, uint index, uint end) {
    const uint place = place_of(segment.kind, end);
    if (place == k_place_inside) return k_no_link;
    if (place < k_place_corner) return link_across(segment, place);
    return link_at(segment, 2u * index + end, texelFetch(joined_faces, int(segment.face))[place - k_place_corner]);
}

void main() {
    const uint index = linear_thread();
    if (index >= counts.segments) return;

    const LineSegmentRecord segment = segment_at(index);
    const uvec3 corners = texelFetch(faces, int(segment.face)).xyz;
    const mat3 points = mat3(texelFetch(positions, int(corners.x)).xyz, texelFetch(positions, int(corners.y)).xyz,
                             texelFetch(positions, int(corners.z)).xyz);
    for (uint end = 0; end < 2; ++end) {
        const vec3 at = points * end_of(segment, end);
        picture_ends[2u * index + end] = in_picture(at);
    }
    links[index] = uvec2(link_of(segment, index, 0u), link_of(segment, index, 1u));
}
