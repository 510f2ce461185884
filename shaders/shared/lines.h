#ifndef EXEMPLAR_SHARED_LINES_H
#define EXEMPLAR_SHARED_LINES_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Families of lines, in the order of exemplar::LineType; of principal highlights there are two.
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
const uint k_line_families = 10;

const uint k_field_families = 0xffu;      // the bits of those that are found by fields
const uint k_curvature_families = 0xfeu;  // by fields of curvature
const uint k_axis_families = 0xf8u;       // by fields that have directions
const uint k_extremum_families = 0x38u;   // and are the extrema along them
const uint k_highlight_families = 0xc0u;
const uint k_edge_families = 0x300u;  // edges of the mesh

// Fields have a vec4 per vertex: value, strength, margin and front of exemplar::LineField; those of all families that
// are wanted follow each other, as do the directions of those that have some. The bits of the families that are wanted
// are a constant of the kernels (id 0).
struct FieldParameters {
    vec4 eye;              // its position and 1, or for a parallel projection the unit direction to it and 0
    vec4 low_thresholds;   // of families 0 to 3
    vec4 high_thresholds;  // of families 4 to 7
    uint vertices;
    float feature_size;
    uint unused0;
    uint unused1;
};

// What is across the sides of a face; exemplar::k_no_neighbor and the like.
const uint k_side_alone = 0xffffffffu;
const uint k_side_of_many = 0xfffffffeu;
const uint k_last_side = 0xfffffffcu;

// Faces in groups of this many count their segments together, segments their points.
const uint k_count_group = 64;

struct FaceLineParameters {
    uint faces;
    uint vertices;
    float crease_angle;  // radians
    uint most_segments;  // what there is room for
};

// A segment: its face, what it is, the strength of its ends, and two barycentric coordinates of each end, those of the
// second and the third corner.
struct LineSegmentRecord {
    uint face;
    uint kind;  // family, then the places of both ends
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

// Numbers that the device finds by itself: how much there is, and the arguments of indirect commands.
const uint k_line_rounds = 22;  // of jumps: chains of up to 2^22 segments
struct LineCounts {
    uint segments;
    uint points;
    uint dropped_segments;   // for which there was no room
    uint previous_segments;  // of the extraction before
    uint segment_groups[3];
    uint trace_groups[3];  // for the segments of both
    uint node_groups[3];
    uint point_groups[3];
    uint draw[4];
    uint round_groups[66];
};

struct ScanParameters {
    uint groups;  // to scan; 0: as many as LineCounts has groups of segments
    uint most;    // what there is room for
};

const uint k_no_link = 0xffffffffu;

// Segments continue each other at their ends; link 2 s + e leads to the end it is joined with. A node is a segment that
// is left by one of its ends, 2 s + e; the way on leads from node to node.
struct LinkParameters {
    vec4 matrix[4];  // columns: world to clip space
    float width;     // of the picture, in pixels
    float height;
    uint unused0;
    uint unused1;
};

// A point of a chain in the picture. The points of a chain follow each other.
struct LinePoint {
    float x;  // pixels, to the right and down
    float y;
    float depth;      // in [0, 1]
    float parameter;  // pixels along the chain
    uint kind;        // family and flags
    uint chain;       // its first segment
    uint segment;     // on the way on to the next point, 2 s + 1 if it is walked from its second end; of the last point
                      // the last
    float strength;
};
const uint k_point_first = 0x10u;
const uint k_point_last = 0x20u;
const uint k_point_closed = 0x40u;

// Samples of visibility on the way from a point to the next are this many pixels apart, if 32 are enough.
const float k_sample_spacing = 1.0f;

// For what lies on the surface, depths are off by this part of the unit of depth at most; contours, and what lies on
// faces that turn away although the surface does not, may be so many edges of their face behind it.
const float k_depth_tolerance = 2e-3f;
const float k_edge_tolerance = 1.5f;

// How the strokes of a family look: exemplar::StrokeThickness and more.
struct StrokeLook {
    vec4 color;  // sRGB, and opacity
    float width;
    float epsilon;
    float least;
    float most;
    float taper;
    float threshold;  // opacity is x / (x + fade) of the strength x above it; a fade of zero: all opaque
    float fade;
    uint texture;  // 0: none; else it begins at texel texture - 1
    float period;  // of the texture, in pixels along the stroke
    float unused0;
    float unused1;
    float unused2;
};
// How far points are moved to the mean of the chain around them: exemplar::make_strokes.
const int k_least_calm = 3;  // pixels
const int k_most_calm = 10;
const int k_calm_points = 8;
const int k_calm_reach = 2;
const uint k_texture_width = 256;
const uint k_texture_height = 32;

struct StrokeParameters {
    vec4 eye;
    vec4 axis;   // of the camera, into the picture, in world space, and what to add for the depth of a point
    uint width;  // of the picture, in pixels
    uint height;
    float near_term;  // depth to view depth: near_term / (far_term - depth),
    float far_term;   // or for a parallel projection near_term + far_term * depth
    float feature_size;
    float unit_depth;
    uint parallel;
    uint curved;  // whether there is curvature
    uint closed;  // whether the surface has no boundary
    uint unused0;
    uint unused1;
    uint unused2;
};

struct StrokeDrawParameters {
    float width;  // of the picture, in pixels
    float height;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(FieldParameters, eye, low_thresholds, high_thresholds, vertices, feature_size, unused0, unused1)
EXEMPLAR_LAYOUT(FaceLineParameters, faces, vertices, crease_angle, most_segments)
EXEMPLAR_LAYOUT(LineSegmentRecord, face, kind, first_strength, second_strength, ends)
EXEMPLAR_LAYOUT(ScanParameters, groups, most)
EXEMPLAR_LAYOUT(LinkParameters, matrix, width, height, unused0, unused1)
EXEMPLAR_LAYOUT(LinePoint, x, y, depth, parameter, kind, chain, segment, strength)
EXEMPLAR_LAYOUT(StrokeLook, color, width, epsilon, least, most, taper, threshold, fade, texture, period, unused0,
                unused1, unused2)
EXEMPLAR_LAYOUT(StrokeParameters, eye, axis, width, height, near_term, far_term, feature_size, unit_depth, parallel, curved,
                closed, unused0, unused1, unused2)
EXEMPLAR_LAYOUT(StrokeDrawParameters, width, height)
#endif

SHARED_END
#endif
