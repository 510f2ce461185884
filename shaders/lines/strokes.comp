#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Computes how points are drawn (host/lines/strokes/strokes.cpp): position, normal across the stroke, width, tapered
// towards the ends of visible runs, and opacity. One point per invocation: reads its segment, the corners of its
// face and the points around it, all from caches, and writes 32.
layout(local_size_x = k_count_group) in;
layout(push_constant) uniform Push { StrokeParameters parameters; };
layout(set = 0, binding = 0) uniform usamplerBuffer points;  // LinePoint, two texels each
layout(set = 0, binding = 1) uniform usamplerBuffer visible;  // two words per point
layout(set = 0, binding = 2) uniform usamplerBuffer segments;
layout(set = 0, binding = 3) uniform usamplerBuffer faces;
layout(set = 0, binding = 4) uniform samplerBuffer positions;
layout(set = 0, binding = 5) uniform samplerBuffer first;
layout(set = 0, binding = 6) uniform samplerBuffer second;
layout(set = 0, binding = 7) uniform usamplerBuffer neighbors;
layout(set = 0, binding = 8) uniform usamplerBuffer face_inks;  // index of an ink per face, if there are some
layout(set = 0, binding = 9) uniform usamplerBuffer point_counts;   // points of chains before each segment in its group
layout(set = 0, binding = 10) uniform usamplerBuffer point_groups;  // and before its group
layout(set = 0, binding = 11, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 12, std430) readonly buffer Looks { StrokeLook looks[]; };  // per family
layout(set = 0, binding = 14, std430) readonly buffer Inks { vec4 inks[]; };  // color; factor of the width
// Two per point: position, width, opacity; normal, index of the ink.
layout(set = 0, binding = 13, std430) writeonly buffer Strokes { vec4 strokes[]; };
#include "shaders/lines/segments.glsl"
#include "shaders/lines/stroke_points.glsl"

const uint k_max_taper_points = 64;

// Returns the first point of the chain that begins with a segment, or else of the next chain; the number of all points
// behind the last segment.
int first_point(uint segment) {
    if (segment >= counts.segments) return int(counts.points);
    return int(texelFetch(point_groups, int(segment / k_count_group)).x + texelFetch(point_counts, int(segment)).x);
}

// Returns the previous or next point. Wraps around on closed chains, whose last point is the first; stays at the end
// of open ones.
int neighbor(int point, int way) {
    const uvec2 kind_and_chain = texelFetch(points, 2 * point + 1).xy;
    if ((kind_and_chain.x & (way > 0 ? k_point_last : k_point_first)) == 0u) return point + way;
    if ((kind_and_chain.x & k_point_closed) == 0u) return point;
    return way > 0 ? first_point(kind_and_chain.y) + 1 : first_point(kind_and_chain.y + 1u) - 2;
}

vec2 place_of_point(int point) {
    return uintBitsToFloat(texelFetch(points, 2 * point).xy);
}

// The smoothing window on one side of a point: integral of the position over its length, length, and end.
struct Side {
    vec2 sum;
    float pixels;
    vec2 end;
};
Side side_of(int point, int way) {
    float reach = 0.0;
    int here = point;
    for (int i = 0; i < k_smoothing_window_reach; ++i) {
        const int next = neighbor(here, way);
        reach += distance(place_of_point(next), place_of_point(here));
        here = next;
    }
    reach = clamp(reach, k_min_smoothing_window, k_max_smoothing_window);
    Side result = Side(vec2(0.0), 0.0, place_of_point(point));
    here = point;
    for (int i = 0; i < k_smoothing_window_points && result.pixels < reach; ++i) {
        const int next = neighbor(here, way);
        const vec2 from = place_of_point(here), on = place_of_point(next) - from;
        const float size = length(on), part = min(size, reach - result.pixels);
        if (size > 0.0) {
            const vec2 end = from + part / size * on;
            result.sum += part * 0.5 * (from + end);
            result.pixels += part;
            result.end = end;
        }
        here = next;
    }
    return result;
}

// Returns the direction along a chain from a point to one some pixels on; zero at the end.
vec2 direction(int point, int way) {
    vec2 on = vec2(0.0);
    int next = point;
    for (int i = 0; i < k_smoothing_window_points && !(length(on) >= float(k_min_smoothing_window)); ++i) {
        next = neighbor(next, way);
        on = place_of_point(next) - place_of_point(point);
    }
    const float size = length(on);
    return size > 0.0 ? on / size : vec2(0.0);
}

// A smoothed point: its position, its normal, and exemplar::straightness.
struct SmoothedPoint {
    vec2 at;
    vec2 normal;
    float straightness;
};
SmoothedPoint smoothed_point(int point, uint kind) {
    const vec2 here = place_of_point(point);
    vec2 tangent = vec2(0.0), there = here;
    float straightness = 1.0;
    if ((1u << (kind & k_kind_family) & k_edge_families) != 0u) {
        const vec2 ahead = direction(point, 1);
        tangent = ahead - direction(point, -1);
        if (!(length(tangent) > k_least_tangent)) tangent = ahead;
    } else {
        const Side before = side_of(point, -1), after = side_of(point, 1);
        tangent = after.end - before.end;
        const bool stays = (kind & k_point_closed) == 0u && (kind & (k_point_first | k_point_last)) != 0u;
        const float size = before.pixels + after.pixels;
        if (!stays && size > 0.0) there = (before.sum + after.sum) / size;
        if (size > 0.0) straightness = min(1.0, 2.0 * length(tangent) / size);
    }
    const float size = length(tangent);
    return SmoothedPoint(there, size > 0.0 ? vec2(-tangent.y, tangent.x) / size : vec2(0.0, 1.0), straightness);
}

// Returns the segment at a point, and which end of it is there.
uvec2 segment_end(int point) {
    const uvec4 more = texelFetch(points, 2 * point + 1);
    const uint begin_end = more.z & 1u;
    const bool last = (more.x & k_point_last) != 0u;
    return uvec2(more.z >> 1, last ? 1u - begin_end : begin_end);
}

// Returns whether a contour ends at a point on an edge, along which another goes on.
bool goes_on_along_edge(int point) {
    const uvec2 at = segment_end(point);
    const uvec2 head = texelFetch(segments, int(2u * at.x)).xy;
    const uint place = place_of(head.y, at.y);
    if ((head.y & k_kind_family) != k_contours || place >= k_place_corner) return false;
    const uint across = texelFetch(neighbors, int(head.x))[place];
    return across >= k_blocked_side || (across & k_sharp_side) != 0u;
}

float thickness(LineSegmentRecord segment, uint end, StrokeLook look) {
    const vec3 weights = end_of(segment, end);
    const uvec3 corners = texelFetch(faces, int(segment.face)).xyz;
    float curvature = 0.0, z = 0.0;
    for (uint i = 0; i < 3; ++i) {
        if (parameters.curved != 0u) curvature += weights[i] * radial_curvature(int(corners[i]));
        z += weights[i] * (dot(parameters.axis.xyz, texelFetch(positions, int(corners[i])).xyz) + parameters.axis.w);
    }
    z = parameters.parallel != 0u ? 1.0 : max(z / parameters.unit_depth, 1e-6);
    return clamp(look.width * look.epsilon / (z * (max(curvature, 0.0) + look.epsilon)), look.least, look.most);
}

// Returns the pixels from a point along its chain to the end of its visible run, at most `most`.
float visible_length(int point, int way, float most) {
    float sum = 0.0;
    for (uint i = 0; i < k_max_taper_points && sum < most; ++i) {
        const int next = neighbor(point, way);
        if (next == point) return goes_on_along_edge(point) ? most : sum;
        const int link = way > 0 ? (next == point + 1 ? point : next - 1) : next;
        const uint mask = texelFetch(visible, 2 * link).x, samples = texelFetch(visible, 2 * link + 1).x;
        const uint all = samples == 32u ? 0xffffffffu : (1u << samples) - 1u;
        const float pixels = distance(place_of_point(link), place_of_point(link + 1));
        if (mask != all) {
            const uint hidden = ~mask & all;
            const uint seen = way > 0 ? uint(findLSB(hidden)) : samples - 1u - uint(findMSB(hidden));
            return min(sum + pixels * float(seen) / float(samples), most);
        }
        sum += pixels;
        point = next;
    }
    return most;
}

float tapered(int point, float straightness, StrokeLook look) {
    if (!(look.taper > 0.0)) return 1.0;
    const float d = min(visible_length(point, 1, look.taper), visible_length(point, -1, look.taper));
    const float x = clamp(d / look.taper, 0.0, 1.0);
    return straightness * sqrt(x * (2.0 - x));
}

void main() {
    const int point = int(linear_thread());
    if (point >= int(counts.points)) return;

    const uvec4 more = texelFetch(points, 2 * point + 1);
    const uint kind = more.x;
    const StrokeLook look = looks[kind & k_kind_family];
    const SmoothedPoint drawn = smoothed_point(point, kind);
    const bool along_edge = (1u << (kind & k_kind_family) & k_edge_families) != 0u;
    const uvec2 at = segment_end(point);
    const LineSegmentRecord segment = segment_at(at.x);
    const uint ink = parameters.inked != 0u ? texelFetch(face_inks, int(segment.face)).x : 0u;
    float width = thickness(segment, at.y, look) * (along_edge ? 1.0 : tapered(point, drawn.straightness, look));
    if (parameters.inked != 0u) width *= inks[ink].w;
    const float above = max(uintBitsToFloat(more.w) - look.threshold, 0.0);
    const float opacity = look.fade > 0.0 ? above / (above + look.fade) : 1.0;
    strokes[2 * point] = vec4(drawn.at, width, opacity);
    strokes[2 * point + 1] = vec4(drawn.normal, float(ink), 0.0);
}
