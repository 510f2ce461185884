#ifndef EXEMPLAR_SHARED_HATCHING_FEATURES_H
#define EXEMPLAR_SHARED_HATCHING_FEATURES_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Columns of values per vertex come in slabs: of each vertex, in turn, k_slab_quads vec4s.
const uint k_slab_quads = 8;
const uint k_slab_lanes = 32;
// Fields of directions come in slabs too: of each vertex k_slab_fields vec4s.
const uint k_slab_fields = 4;

// A slab at points of faces.
struct ProjectionParameters {
    uint points;
    uint stride;  // points from one column of barycentrics and of the output to the next: a multiple of 4
    uint quads;   // of the slab that count
};

// Fields of directions in the picture.
struct DirectionParameters {
    vec4 clip_x;  // rows of the view-projection matrix
    vec4 clip_y;
    vec4 clip_w;
    uint points;
    uint stride;
    uint fields;  // of the slab that count
    float width;  // of the picture, in pixels
    float height;
    uint unused0;
    uint unused1;
    uint unused2;
};

// View-dependent curvature at one scale. Of each vertex there are k_curvature_texels: position and normal, then at each
// scale e1 with k1, e2 with k2, and the derivative; curvatures in units of 1 / (median distance).
const uint k_curvature_texels = 11;
const uint k_curvature_values = 15;
struct ViewCurvatureParameters {
    vec4 eye;  // and 1; of a parallel projection the direction to it, and 0
    uint vertices;
    uint scale;
    float limit;      // of curvatures
    uint unused;
    uint columns[8];  // of the scale, a byte for each lane of the slab: 2 k is value k, 2 k + 1 its magnitude
};
const uint k_other_scale = 255u;  // lanes that are of another scale, or of none

// Rules of segments: terms [begin[s], begin[s + 1]) of segment s.
struct RuleParameters {
    uint rows;
    uint stride;  // rows from one field to the next
};
struct RuleTerm {
    uint field;
    float weight;
    uint unused0;
    uint unused1;
};

// A property of four rows at a time.
struct PropertyParameters {
    uint quads;   // of rows
    uint stride;  // quads from one column to the next
    uint terms;
    float log_factor;
};
// exemplar::PropertyModel::Term, two texels.
struct PropertyTerm {
    uint column;
    uint power;
    float a;
    float b;
    float exponent;
    float low;
    float high;
    float least;
};
// Values of columns are in [-k_largest_value, k_largest_value], whose squares are finite; what is below is none.
const float k_largest_value = 1e19f;
const float k_no_value = -1e30f;

#ifdef __cplusplus
EXEMPLAR_LAYOUT(ProjectionParameters, points, stride, quads)
EXEMPLAR_LAYOUT(DirectionParameters, clip_x, clip_y, clip_w, points, stride, fields, width, height, unused0, unused1,
                unused2)
EXEMPLAR_LAYOUT(ViewCurvatureParameters, eye, vertices, scale, limit, unused, columns)
EXEMPLAR_LAYOUT(RuleParameters, rows, stride)
EXEMPLAR_LAYOUT(RuleTerm, field, weight, unused0, unused1)
EXEMPLAR_LAYOUT(PropertyParameters, quads, stride, terms, log_factor)
EXEMPLAR_LAYOUT(PropertyTerm, column, power, a, b, exponent, low, high, least)
#endif

SHARED_END
#endif
