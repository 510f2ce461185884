#ifndef EXEMPLAR_SHARED_CURVATURE_H
#define EXEMPLAR_SHARED_CURVATURE_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// A vertex's rest position and the start of its influences.
struct RestVertex {
    float x;
    float y;
    float z;
    uint influences;  // index of its first InfluencePair
};

// Two influences on a vertex; an unused second one has weight zero. The last pair of a vertex is marked.
struct InfluencePair {
    uint first_bone;  // with k_last_of_vertex
    float first_weight;
    uint second_bone;
    float second_weight;
};

// The offset of a vertex at full weight of a morph target. The last offset of a vertex is marked.
struct MorphOffset {
    float x;
    float y;
    float z;
    uint target;  // with k_last_of_vertex
};

const uint k_last_of_vertex = 0x80000000u;

struct PoseParameters {
    uint vertices;
    uint first_weight;  // index of the first target weight in the pose, in floats
    uint targets;
};

// The ring of a vertex: the other corners of its faces in order around it, four per texel. Two consecutive entries
// form a face with the vertex, unless the second starts a fan (k_ring_fan). The last entry of a vertex is marked
// (k_ring_last).
const uint k_ring_fan = 0x80000000u;
const uint k_ring_last = 0x40000000u;
const uint k_ring_vertex = 0x3fffffffu;

struct SurfaceParameters {
    uint vertices;
    float scale;  // factor from mesh units to units in which edges are about 1 long
};

// The vertices that may come near a vertex, four per texel; the last texel is marked in w. Padding: the vertex
// itself.
const uint k_near_last = 0x80000000u;
const uint k_near_vertex = 0x7fffffffu;

// The diffusion kernel exp(-d^2 / (2 s^2)) - k_diffusion_rest ends, at zero, at d^2 = 2 k_diffusion_cutoff s^2.
const float k_diffusion_cutoff = 4.0f;
const float k_diffusion_rest = 0.018315639f;  // exp(-k_diffusion_cutoff)

struct DiffusionParameters {
    uint first;       // first vertex of the tile
    uint vertices;    // number in the tile
    uint near_first;  // first texel of the tile among those of all rows
    float scale;      // as in SurfaceParameters; the others are in scaled units
    float exponent;   // -1 / (2 s^2)
    float limit;      // maximum squared distance
};

// A feature of learned curvature: a neuron, or the product of three inputs. The input after the last one is the
// constant 1.
struct CurvatureFeature {
    uint first;
    uint second;
    uint third;
    uint neuron;  // 1 + its index; 0 for none
};

// Coefficients and features of one component, four per texel.
struct CurvatureComponent {
    uint first_feature;  // texel
    uint feature_texels;
    uint first_coefficient;  // texel
    uint unused;
};

struct FeatureParameters {
    uint features;
    uint first_input;   // index among the uploaded floats of a pose; a multiple of four
    uint input_texels;  // including the constant 1, four per texel
};

// Invocations that add up a row on cards (shaders/lib/row_lanes.glsl).
const uint k_row_group = 64;

struct ComponentParameters {
    uint components;
};

// Learned curvature of local shape reads its inputs from patches. Each corner of a patch' triangle is the mean of
// this many vertices, four per texel.
const uint k_corner_vertices = 8;

struct PatchParameters {
    uint patches;
};

// An input of local shape: half-float weights of normal and height per vertex of its patch, 2 vertices per texel.
struct LocalInput {
    uint surface_patch;
    uint first_vertex;  // index in the list of all patches' vertices
    uint vertices;
    uint first_texel;
};

struct LocalInputParameters {
    uint inputs;
    float inverse_unit;
};

// Vertices of learned curvature are in tiles of four quads. A tile is a run of texels:
// 1. 1 texel: the number of groups of each attribute, two per word.
// 2. 1 texel per quad: its vertices. Tensors only: 1 more per quad, the neighbors that the first axes point to.
// 3. 4 texels, one per quad, per pair of rows of halves (two words of each row): the means of all attributes and,
//    if principal, the reference normals. A last single row is paired with zeros.
// 4. The bases, attribute by attribute, in groups of four entries: 4 texels, one per quad, per group. In a texel
//    each entry has a word, a byte per vertex. The last group of an attribute is padded with zeros.
const uint k_tile_quads = 4;
const uint k_principal_head = 5;  // texels before part 3
const uint k_tensor_head = 9;
struct CurvatureTile {
    uint first_texel;
    uint first_group;  // of entries (component and step)
    uint segment;
    uint unused;
};

struct ReprojectionParameters {
    vec4 low_scales;   // factors of the means of attributes 0 to 3
    vec4 high_scales;  // and of attributes 4 to 7
    uint first_tile;
    uint tiles;
    uint first_texel;  // first texel of the bound range
    uint first_group;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(CurvatureFeature, first, second, third, neuron)
EXEMPLAR_LAYOUT(CurvatureComponent, first_feature, feature_texels, first_coefficient, unused)
EXEMPLAR_LAYOUT(FeatureParameters, features, first_input, input_texels)
EXEMPLAR_LAYOUT(ComponentParameters, components)
EXEMPLAR_LAYOUT(PatchParameters, patches)
EXEMPLAR_LAYOUT(LocalInput, surface_patch, first_vertex, vertices, first_texel)
EXEMPLAR_LAYOUT(LocalInputParameters, inputs, inverse_unit)
EXEMPLAR_LAYOUT(CurvatureTile, first_texel, first_group, segment, unused)
EXEMPLAR_LAYOUT(ReprojectionParameters, low_scales, high_scales, first_tile, tiles, first_texel, first_group)
EXEMPLAR_LAYOUT(RestVertex, x, y, z, influences)
EXEMPLAR_LAYOUT(InfluencePair, first_bone, first_weight, second_bone, second_weight)
EXEMPLAR_LAYOUT(MorphOffset, x, y, z, target)
EXEMPLAR_LAYOUT(PoseParameters, vertices, first_weight, targets)
EXEMPLAR_LAYOUT(SurfaceParameters, vertices, scale)
EXEMPLAR_LAYOUT(DiffusionParameters, first, vertices, near_first, scale, exponent, limit)
#endif

SHARED_END
#endif
