#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/lib/dispatch.glsl"
#include "shaders/shared/lines.h"

// Finds the visible samples between each point and the next: a bit each, and their number. A sample is hidden if all
// 3 x 3 pixels around it show something nearer. One point per invocation: reads 64 bytes and 36 per sample, from
// caches, and writes 8.
layout(local_size_x = k_count_group) in;
layout(push_constant) uniform Push { StrokeParameters parameters; };
layout(set = 0, binding = 0) uniform samplerBuffer depths;  // rows of pixels from the top
layout(set = 0, binding = 1) uniform usamplerBuffer points;  // LinePoint, two texels each
layout(set = 0, binding = 2) uniform usamplerBuffer segments;
layout(set = 0, binding = 3) uniform usamplerBuffer faces;
layout(set = 0, binding = 4) uniform samplerBuffer positions;
layout(set = 0, binding = 5) uniform samplerBuffer first;
layout(set = 0, binding = 6) uniform samplerBuffer second;
layout(set = 0, binding = 7) uniform usamplerBuffer neighbors;
layout(set = 0, binding = 8) uniform samplerBuffer normals;
layout(set = 0, binding = 9, std430) readonly buffer Counts { LineCounts counts; };
layout(set = 0, binding = 10, std430) writeonly buffer Visible { uvec2 visible[]; };
#include "shaders/lines/segments.glsl"
#include "shaders/lines/stroke_points.glsl"

float view_depth(float depth) {
    return parameters.parallel != 0u ? parameters.near_term + parameters.far_term * depth
                                     : parameters.near_term / (parameters.far_term - depth);
}

bool is_visible(vec2 at, float depth, float tolerance) {
    if (tolerance < 0.0 || any(lessThan(at, vec2(0.0))) || at.x >= float(parameters.width) || at.y >= float(parameters.height)) return false;
    const ivec2 low = max(ivec2(at) - 1, ivec2(0));
    const ivec2 high = min(ivec2(at) + 1, ivec2(parameters.width, parameters.height) - 1);
    float farthest = 0.0;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
            farthest = max(farthest, texelFetch(depths, y * int(parameters.width) + x).x);
    return farthest >= 1.0 || view_depth(depth) <= view_depth(farthest) + tolerance;
}

float facing(int vertex) {
    const vec3 normal = cross(texelFetch(first, vertex).xyz, texelFetch(second, vertex).xyz);
    return dot(normal, to_eye(parameters.eye, texelFetch(positions, vertex).xyz));
}

bool is_at_sharp_edge(int face) {
    const uvec3 across = texelFetch(neighbors, face).xyz;
    for (uint side = 0; side < 3; ++side)
        if (across[side] < k_blocked_side && (across[side] & k_sharp_side) != 0u) return true;
    return false;
}

float facing_of(uint vertex, vec3 place) {
    return dot(texelFetch(normals, int(vertex)).xyz, to_eye(parameters.eye, place));
}

// Returns whether n.w, which is linear in a face, grows towards the eye: the surface then bends away from the ray.
bool grows_to_eye(uvec3 corners, mat3 places) {
    const vec3 a = places[0], b = places[1], c = places[2], across = cross(b - a, c - a);
    const vec3 gradient = facing_of(corners.x, a) * cross(across, c - b) + facing_of(corners.y, b) * cross(across, a - c) +
                          facing_of(corners.z, c) * cross(across, b - a);
    return dot(gradient, to_eye(parameters.eye, (a + b + c) / 3.0)) > 0.0;
}

// Returns the distance of a place from the line through the origin.
float distance_from_line(vec3 place, vec3 line) {
    const float squared = dot(line, line);
    return squared > 0.0 ? length(cross(place, line)) * inversesqrt(squared) : length(place);
}

// Returns how far a segment may be behind the depth image; negative: it is hidden for certain. A contour of smooth
// normals lies up to an edge behind the outline of its faces, unless radial curvature is not positive, where the
// surface itself hides it. Near an outline, faces may turn away where the smooth surface does not yet.
float tolerance_of(uint index) {
    const LineSegmentRecord segment = segment_at(index);
    const uvec3 corners = texelFetch(faces, int(segment.face)).xyz;
    const vec3 a = texelFetch(positions, int(corners.x)).xyz, b = texelFetch(positions, int(corners.y)).xyz,
               c = texelFetch(positions, int(corners.z)).xyz;
    const uint family = family_of(segment);
    bool behind = parameters.curved == 0u;
    if (parameters.curved != 0u && family == k_contours) {
        behind = is_at_sharp_edge(int(segment.face))
                     ? grows_to_eye(corners, mat3(a, b, c))
                     : radial_curvature(int(corners.x)) + radial_curvature(int(corners.y)) + radial_curvature(int(corners.z)) > 0.0;
        if (!behind && parameters.closed != 0u) return -1.0;
    }
    if (parameters.curved != 0u && family != k_contours) {
        behind = dot(cross(b - a, c - a), to_eye(parameters.eye, a)) < 0.0;
        // Other families are cut off already where the smooth surface turns away.
        if (family == k_ridges || family == k_valleys)
            behind = behind && facing(int(corners.x)) + facing(int(corners.y)) + facing(int(corners.z)) > 0.0;
    }
    if ((1u << family & k_edge_families) != 0u) behind = false;
    if (!behind) return k_depth_tolerance * parameters.unit_depth;
    const mat3 corner_places = mat3(a, b, c);
    const vec3 from = corner_places * end_of(segment, 0u), along = corner_places * end_of(segment, 1u) - from;
    const float longest = sqrt(max(dot(b - a, b - a), max(dot(c - b, c - b), dot(a - c, a - c))));
    const float aside = max(distance_from_line(a - from, along), max(distance_from_line(b - from, along), distance_from_line(c - from, along)));
    // Beside a line that points to the eye, what is aside is as much nearer.
    const float slant = distance_from_line(to_eye(parameters.eye, from), along);
    const float reach = min(k_edge_tolerance * longest, k_aside_tolerance * aside / max(slant, 1e-3));
    return k_depth_tolerance * parameters.unit_depth + reach;
}

void main() {
    const uint index = linear_thread();
    if (index >= counts.points) return;

    const vec4 here = uintBitsToFloat(texelFetch(points, int(2u * index)));
    const uvec4 kind = texelFetch(points, int(2u * index + 1u));
    const float tolerance = tolerance_of(kind.z / 2u);
    if ((kind.x & k_point_last) != 0u) {
        visible[index] = uvec2(is_visible(here.xy, here.z, tolerance) ? 1u : 0u, 1u);
        return;
    }
    const vec3 there = uintBitsToFloat(texelFetch(points, int(2u * index + 2u)).xyz);
    // The length of a piece behind the eye or far outside of the picture is meaningless, so it is clamped.
    const float pixels = distance(here.xy, there.xy);
    const uint samples = uint(clamp(ceil(pixels / k_sample_spacing), 1.0, 32.0));
    uint mask = 0;
    for (uint i = 0; i < samples; ++i) {
        const vec3 at = mix(here.xyz, there, (float(i) + 0.5) / float(samples));
        if (at.z >= 0.0 && at.z <= 1.0 && is_visible(at.xy, at.z, tolerance)) mask |= 1u << i;
    }
    visible[index] = uvec2(mask, samples);
}
