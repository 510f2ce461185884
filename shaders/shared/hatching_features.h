#ifndef EXEMPLAR_SHARED_HATCHING_FEATURES_H
#define EXEMPLAR_SHARED_HATCHING_FEATURES_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// Columns of values per vertex are stored in slabs: k_slab_quads vec4s for each vertex in turn.
const uint k_slab_quads = 8;
const uint k_slab_lanes = 32;
// Fields of directions are stored in slabs, too: k_slab_fields vec4s for each vertex.
const uint k_slab_fields = 4;

// Parameters of the interpolation of a slab at points of faces.
struct ProjectionParameters {
    uint points;
    uint stride;  // points from one column of barycentrics and of the output to the next: a multiple of 4
    uint quads;   // number of used quads of the slab
};

// Parameters of the projection of direction fields to the picture.
struct DirectionParameters {
    vec4 clip_x;  // rows of the view-projection matrix
    vec4 clip_y;
    vec4 clip_w;
    uint points;
    uint stride;
    uint fields;  // number of used fields of the slab
    float width;  // of the picture, in pixels
    float height;
    uint unused0;
    uint unused1;
    uint unused2;
};

// View-dependent curvature at one scale. Each vertex has k_curvature_texels: position and normal, then for each
// scale e1 with k1, e2 with k2, and the derivative. Curvatures are in units of 1 / (median distance).
const uint k_curvature_texels = 11;
const uint k_curvature_values = 15;
struct ViewCurvatureParameters {
    vec4 eye;  // position of the eye and 1, or the direction to it and 0 for a parallel projection
    uint vertices;
    uint scale;
    float limit;  // bound of curvatures
    uint unused;
    uint columns[8];  // one byte per lane of the slab: 2 k is value k of this scale, 2 k + 1 its magnitude
};
const uint k_other_scale = 255u;  // marks lanes of another scale, or of none

// Rules of segments: segment s has the terms [begin[s], begin[s + 1]).
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

// Evaluation of a property, four rows at a time.
struct PropertyParameters {
    uint quads;   // number of groups of four rows
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
// Values of columns are in [-k_max_value, k_max_value], whose squares are finite; lower ones mean that there
// is no value.
const float k_max_value = 1e19f;
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
