#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/coherence.h"

// Finds the line of the previous frame nearest to each piece of a chain: of its family, in its face or else,
// perpendicular to the line on either side, in the first face that has one. The piece votes for the texture's
// placement there (host/lines/strokes/coherence.cpp). One point per invocation: reads 64 bytes and, from caches,
// some faces and their lines; writes 32 and adds 12 to the votes of its chain. The sums are of integers, so their
// order does not matter.
layout(local_size_x = k_count_group) in;
layout(set = 0, binding = 0) uniform usamplerBuffer points;  // LinePoint, two texels each
layout(set = 0, binding = 1) uniform usamplerBuffer segments;
layout(set = 0, binding = 2) uniform usamplerBuffer faces;
layout(set = 0, binding = 3) uniform usamplerBuffer neighbors;
layout(set = 0, binding = 4) uniform samplerBuffer positions;
// The lines of the previous frame; traces.comp has written old_ends.
layout(set = 0, binding = 5) uniform usamplerBuffer face_counts;
layout(set = 0, binding = 6) uniform usamplerBuffer groups;
layout(set = 0, binding = 7) uniform usamplerBuffer old_segments;
layout(set = 0, binding = 8) uniform samplerBuffer old_ends;
layout(set = 0, binding = 9, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 10, std430) readonly buffer Looks { StrokeLook looks[]; };
layout(set = 0, binding = 11, std430) buffer Votes { ChainVotes votes[]; };
// Two texels of bits per point, for the piece to the next point. Match: texture coordinate of the previous line, share of it
// that was drawn or -1 if there was none, period of the texture. Vote: weight times cosine and sine, pixels along
// the chain, and 2 * chain + 1 if the texture runs against the chain, else + 0.
layout(set = 0, binding = 12, std430) writeonly buffer Matches { uvec4 matches[]; };
#include "shaders/lines/face_segments.glsl"
#include "shaders/lines/segments.glsl"

const float k_nowhere = 3e38;
const float k_pi = 3.14159265358979;

struct Match {
    float away;  // pixels
    float texture_at;
    bool along;
    float drawn;
};

void look_in(uint face, uint family, vec2 here, vec2 way, inout Match best) {
    const uvec2 others = segments_of(face, counts.previous_segments);
    for (uint i = others.x; i < others.y; ++i) {
        if ((texelFetch(old_segments, int(2u * i)).y & k_kind_family) != family) continue;
        const vec4 a = texelFetch(old_ends, int(2u * i)), b = texelFetch(old_ends, int(2u * i + 1u));
        if (a.w < 0.0 || b.w < 0.0) continue;
        const vec2 on = b.xy - a.xy;
        const float squared = dot(on, on);
        // Texture coordinates are extrapolated by up to its length beyond its ends.
        const float t = squared > 0.0 ? clamp(dot(here - a.xy, on) / squared, -1.0, 2.0) : 0.5;
        const float away = distance(here, a.xy + clamp(t, 0.0, 1.0) * on);
        if (away < best.away) best = Match(away, mix(a.z, b.z, t), dot(on, way) * (b.z - a.z) >= 0.0, a.w);
    }
}

vec3 corner_at(uvec3 corners, uint i) {
    return texelFetch(positions, int(corners[i])).xyz;
}

// Returns the neighbor in a direction: across the side opposite to the corner that lies farthest back.
uint face_towards(uint face, vec3 way) {
    const uvec3 corners = texelFetch(faces, int(face)).xyz;
    const vec3 at = vec3(dot(corner_at(corners, 0u), way), dot(corner_at(corners, 1u), way), dot(corner_at(corners, 2u), way));
    const uint side = at.x <= at.y && at.x <= at.z ? 1u : at.y <= at.z ? 2u : 0u;
    const uint across = texelFetch(neighbors, int(face))[side];
    return across > k_max_side_code ? k_no_link : across / 4u;
}

// Returns the direction perpendicular to the line, within the surface.
vec3 way_off(LineSegmentRecord segment) {
    const uvec3 corners = texelFetch(faces, int(segment.face)).xyz;
    const vec3 a = corner_at(corners, 0u), b = corner_at(corners, 1u), c = corner_at(corners, 2u);
    return cross(cross(b - a, c - a), mat3(a, b, c) * (end_of(segment, 1u) - end_of(segment, 0u)));
}

void look_beside(uint index, uint family, vec2 here, vec2 way, inout Match best) {
    const LineSegmentRecord segment = segment_at(index);
    const vec3 off = way_off(segment);
    for (float side = -1.0; side <= 1.0; side += 2.0) {
        uint face = segment.face;
        Match found = Match(k_nowhere, 0.0, true, -1.0);
        for (uint i = 0; i < k_follow_faces && found.away == k_nowhere; ++i) {
            face = face_towards(face, side * off);
            if (face == k_no_link) break;
            look_in(face, family, here, way, found);
        }
        if (found.away < best.away) best = found;
    }
}

// Returns the vote of a piece: the phase of the texture at the chain's start as an angle, in a vector with the
// weight as length.
vec2 vote(Match match, float along, float size, float period) {
    // Pieces behind the eye have no weight.
    const float weight = size < 1e6 ? min(size, float(k_max_vote)) : 0.0;
    const float begin = match.texture_at + (match.along ? -along : along);
    const float angle = 2.0 * k_pi * fract(begin / period);
    return weight * vec2(cos(angle), sin(angle));
}

void add_vote(uint chain, vec2 vote, bool along) {
    const ivec2 units = ivec2(round(k_vote_unit * vote));
    const int weight = int(round(k_vote_unit * length(vote)));
    atomicAdd(votes[chain].balance, along ? weight : -weight);
    if (along) {
        atomicAdd(votes[chain].along_cos, units.x);
        atomicAdd(votes[chain].along_sin, units.y);
    } else {
        atomicAdd(votes[chain].against_cos, units.x);
        atomicAdd(votes[chain].against_sin, units.y);
    }
}

void main() {
    const uint index = linear_thread();
    if (index >= counts.points) return;

    const vec4 here = uintBitsToFloat(texelFetch(points, int(2u * index)));
    const uvec4 more = texelFetch(points, int(2u * index + 1u));
    const uint kind = more.x, chain = more.y, segment = more.z / 2u;
    const uint family = kind & k_kind_family;
    const float period = looks[family].period;
    if ((kind & k_point_last) != 0u) {
        matches[2u * index] = floatBitsToUint(vec4(0.0, -1.0, period, 0.0));
        matches[2u * index + 1u] = uvec4(floatBitsToUint(vec3(0.0, 0.0, here.w)), 2u * chain);
        return;
    }
    const vec2 there = uintBitsToFloat(texelFetch(points, int(2u * index + 2u)).xy), middle = 0.5 * (here.xy + there), way = there - here.xy;
    const float size = length(way), along = here.w + 0.5 * size;
    Match match = Match(k_nowhere, 0.0, true, -1.0);
    look_in(texelFetch(segments, int(2u * segment)).x, family, middle, way, match);
    if (match.away == k_nowhere) look_beside(segment, family, middle, way, match);
    const bool found = match.away < k_nowhere;
    const vec2 own = found ? vote(match, along, size, period) : vec2(0.0);
    matches[2u * index] = floatBitsToUint(vec4(match.texture_at, match.drawn, period, 0.0));
    matches[2u * index + 1u] = uvec4(floatBitsToUint(vec3(own, along)), 2u * chain + (match.along ? 0u : 1u));
    if (own != vec2(0.0)) add_vote(chain, own, match.along);
}
