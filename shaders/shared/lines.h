#ifndef EXEMPLAR_SHARED_LINES_H
#define EXEMPLAR_SHARED_LINES_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Families of lines, in the order of exemplar::LineType; principal highlights are two families, and contours along
// edges are one of their own.
const uint k_contours = 0;
const uint k_suggestive_contours = 1;
const uint k_suggestive_highlights = 2;
const uint k_ridges = 3;
const uint k_valleys = 4;
const uint k_apparent_ridges = 5;
const uint k_first_highlights = 6;   // along e1
const uint k_second_highlights = 7;  // along e2
const uint k_creases = 8;
const uint k_boundaries = 9;
const uint k_edge_contours = 10;  // contours along edges of the mesh
const uint k_line_families = 11;

const uint k_field_families = 0xffu;      // bit sets: families found with fields
const uint k_curvature_families = 0xfeu;  // with fields of curvature
const uint k_axis_families = 0xf8u;       // with fields that have directions
const uint k_extremum_families = 0x38u;   // that are extrema along these directions
const uint k_highlight_families = 0xc0u;
const uint k_edge_families = 0x700u;  // that are edges of the mesh

struct GatherParameters {
    uint vertices;  // of the cut surface
};

// A field has a vec4 per vertex: value, strength, margin and front of exemplar::LineField. The fields of all
// requested families follow each other, as do the directions of those that have some. The bits of the requested
// families are constant 0 of the kernels.
struct FieldParameters {
    vec4 eye;              // position and 1, or for a parallel projection the unit direction to the eye and 0
    vec4 low_thresholds;   // of families 0 to 3
    vec4 high_thresholds;  // of families 4 to 7
    uint vertices;
    float feature_size;
};

// Codes of what is across the sides of a face: exemplar::k_no_neighbor, k_blocked_side, k_sharp_side, k_crowded_side
// and k_max_neighbor_code.
const uint k_boundary_side = 0xffffffffu;
const uint k_blocked_side = 0xfffffffeu;
const uint k_sharp_side = 0x80000000u;
const uint k_crowded_side = 0x40000000u;
const uint k_max_side_code = 0x3fffffffu;

// A face is seen edge-on if the sine of the angle between it and the ray to the eye is at most this.
const float k_edge_on_sine = 1e-4f;

// Faces per group when segments are counted, and segments per group when points are counted.
const uint k_count_group = 64;

struct FaceLineParameters {
    vec4 eye;  // as in FieldParameters
    uint faces;
    uint vertices;
    float crease_angle;  // radians
    uint max_segments;   // capacity
};

// A segment. `ends` has two barycentric coordinates of each end, those of the second and the third corner.
struct LineSegmentRecord {
    uint face;
    uint kind;  // family, and the places of both ends in the bits above
    float first_strength;
    float second_strength;
    vec4 ends;
};
const uint k_kind_family = 0xfu;
const uint k_kind_first_place = 4;  // shifts
const uint k_kind_second_place = 7;
const uint k_kind_place = 7u;
const uint k_place_corner = 3;
const uint k_place_inside = 6;

// Counts that the device computes, and the arguments of indirect commands.
const uint k_segment_bits = 22;  // chains have up to 2^22 segments
const uint k_line_rounds = 12;   // rounds of pointer jumping: half as many, and even
struct LineCounts {
    uint segments;
    uint points;
    uint dropped_segments;   // exceeding the capacity
    uint previous_segments;  // of the previous extraction
    uint segment_groups[3];
    uint trace_groups[3];  // for the larger of both numbers of segments
    uint node_groups[3];
    uint point_groups[3];
    uint draw[4];
    uint round_groups[36];
};

struct ScanParameters {
    uint groups;  // number to scan; for points: not used, LineCounts::segment_groups is taken
    uint most;    // capacity
};

const uint k_no_link = 0xffffffffu;

// Segments are joined at their ends; link 2 s + e is the end that end e of segment s is joined with. Node 2 s + e is
// segment s traversed so that it is left at end e; a chain is traversed from node to node.
struct LinkParameters {
    vec4 matrix[4];  // columns: world to clip space
    float width;     // of the picture, in pixels
    float height;
};

// A point of a chain in the picture. The points of a chain are contiguous.
struct LinePoint {
    float x;  // pixels, to the right and down
    float y;
    float depth;      // in [0, 1]
    float parameter;  // arc length along the chain in pixels
    uint kind;        // family and flags
    uint chain;       // index of its first segment
    uint segment;     // 2 s, or 2 s + 1 if segment s is traversed from its second end; s leads to the next point or,
                      // for the last point, comes from the previous one
    float strength;
};
const uint k_point_first = 0x10u;
const uint k_point_last = 0x20u;
const uint k_point_closed = 0x40u;

// Distance in pixels of the samples of visibility between two points; at most 32 samples.
const float k_sample_spacing = 1.0f;

// Maximum depth of lines behind the depth image: k_depth_tolerance unit depths and, for contours and lines on faces
// that turn away although the smooth surface does not, k_edge_tolerance times the longest edge of their face. Long
// faces reach less far beside a line along them: k_aside_tolerance times the distance of their corners from it, over
// the sine of its angle with the ray to the eye.
const float k_depth_tolerance = 2e-3f;
const float k_edge_tolerance = 1.5f;
const float k_aside_tolerance = 4.0f;

// The look of the strokes of a family: exemplar::StrokeThickness, color, fading and texture.
struct StrokeLook {
    vec4 color;  // sRGB, and opacity
    float width;
    float epsilon;
    float least;
    float most;
    float taper;
    float threshold;  // opacity is x / (x + fade), with x the excess of the strength; fade 0: opaque
    float fade;
    uint texture;  // 0: none; else 1 + its first texel
    float period;  // of the texture, in pixels along the stroke
};
// The window in which points are smoothed, see exemplar::make_strokes.
const int k_min_smoothing_window = 3;  // pixels
const int k_max_smoothing_window = 10;
const int k_smoothing_window_points = 8;
const int k_smoothing_window_reach = 2;
// The least sum of two unit directions along a line for the line to have a tangent between them; it turns back below.
const float k_least_tangent = 1e-3f;
const uint k_texture_width = 256;
const uint k_texture_height = 32;

struct StrokeParameters {
    vec4 eye;
    vec4 axis;   // of the camera, into the picture, in world space; w: offset of the depth of a point
    uint width;  // of the picture, in pixels
    uint height;
    float near_term;  // view depth of a depth: near_term / (far_term - depth),
    float far_term;   // or for a parallel projection near_term + far_term * depth
    float feature_size;
    float unit_depth;
    uint parallel;
    uint curved;  // whether there is curvature
    uint closed;  // whether the surface has no boundary
    uint inked;   // whether faces have inks
};

struct StrokeDrawParameters {
    float width;  // of the picture, in pixels
    float height;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(FieldParameters, eye, low_thresholds, high_thresholds, vertices, feature_size)
EXEMPLAR_LAYOUT(FaceLineParameters, eye, faces, vertices, crease_angle, max_segments)
EXEMPLAR_LAYOUT(LineSegmentRecord, face, kind, first_strength, second_strength, ends)
EXEMPLAR_LAYOUT(ScanParameters, groups, most)
EXEMPLAR_LAYOUT(LinkParameters, matrix, width, height)
EXEMPLAR_LAYOUT(LinePoint, x, y, depth, parameter, kind, chain, segment, strength)
EXEMPLAR_LAYOUT(StrokeLook, color, width, epsilon, least, most, taper, threshold, fade, texture, period)
EXEMPLAR_LAYOUT(StrokeParameters, eye, axis, width, height, near_term, far_term, feature_size, unit_depth, parallel,
                curved, closed, inked)
EXEMPLAR_LAYOUT(StrokeDrawParameters, width, height)
#endif

SHARED_END
#endif
