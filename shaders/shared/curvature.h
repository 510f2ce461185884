#ifndef EXEMPLAR_SHARED_CURVATURE_H
#define EXEMPLAR_SHARED_CURVATURE_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// A vertex's place in space and where its influences begin.
struct RestVertex {
    float x;
    float y;
    float z;
    uint influences;  // index of its first InfluencePair
};

// Two influences on a vertex; a bone beyond the palette's weight is zero. The last pair of a vertex is marked.
struct InfluencePair {
    uint first_bone;  // with k_last_of_vertex
    float first_weight;
    uint second_bone;
    float second_weight;
};

// What full weight of a morph target adds to a vertex. The last of a vertex is marked.
struct MorphOffset {
    float x;
    float y;
    float z;
    uint target;  // with k_last_of_vertex
};

const uint k_last_of_vertex = 0x80000000u;

struct PoseParameters {
    uint vertices;
    uint first_weight;  // where the weights of targets begin in the pose, in floats
    uint targets;
};

// The ring of a vertex: the other corners of its faces, in their order around it, four to a texel. Two entries that
// follow each other make a face with the vertex, unless the second starts a fan. The last entry of a vertex is marked.
const uint k_ring_fan = 0x80000000u;
const uint k_ring_last = 0x40000000u;
const uint k_ring_vertex = 0x3fffffffu;

struct SurfaceParameters {
    uint vertices;
    float scale;  // from mesh units to units in which edges are about 1 long
};

// The vertices that may come near a vertex, four to a texel; its last texel is marked in w. Gaps hold the vertex itself.
const uint k_near_last = 0x80000000u;
const uint k_near_vertex = 0x7fffffffu;

// The diffusion kernel exp(-d^2 / (2 s^2)) - k_diffusion_rest ends at d^2 = 2 k_diffusion_cutoff s^2, where it is zero.
const float k_diffusion_cutoff = 4.0f;
const float k_diffusion_rest = 0.018315639f;  // exp(-k_diffusion_cutoff)

struct DiffusionParameters {
    uint first;       // vertex of the tile
    uint vertices;    // in the tile
    uint near_first;  // texel of all rows with which the tile's begin
    float scale;     // as in SurfaceParameters; the others are in scaled units
    float exponent;  // -1 / (2 s^2)
    float limit;     // of the squared distance
};

// A feature of learned curvature: a neuron, or the product of three inputs, of which the last is followed by a one.
struct CurvatureFeature {
    uint first;
    uint second;
    uint third;
    uint neuron;  // 1 + its index; 0 for none
};

// Coefficients and features of one component, four to a texel.
struct CurvatureComponent {
    uint first_feature;      // texel
    uint feature_texels;
    uint first_coefficient;  // texel
    uint unused;
};

struct FeatureParameters {
    uint features;
    uint first_input;   // in floats of what goes up with a pose; a multiple of four
    uint input_texels;  // with the one, four to a texel
};

struct ComponentParameters {
    uint components;
};

// Learned curvature of mesh sequences reads its inputs from the local shape of patches. The corners of a patch' triangle
// are this many vertices each, four to a texel.
const uint k_corner_vertices = 8;

struct PatchParameters {
    uint patches;
};

// An input that is read from local shape: halves for the vertices of its patch, two to a texel (normal, height).
struct LocalInput {
    uint surface_patch;
    uint first_vertex;  // in the list of all patches' vertices
    uint vertices;
    uint first_texel;
};

struct LocalInputParameters {
    uint inputs;
    float inverse_unit;
};

// Vertices of learned curvature come in tiles of four quads. A tile is a run of texels: numbers of groups, one for each
// attribute, two to a word; the vertices of each quad; of tensors, the neighbor of each of these that its first axis leads
// to; then pairs of rows of halves, four texels to a pair, one for each quad, in which the first row has the first two words:
// the means of all attributes and, of principal curvatures, the reference normals (an odd row has zeros beside it); then
// the bases of the attributes, one after the other, in groups of four entries, four texels to a group, one for each quad,
// in which each entry has a word, a byte for each vertex. The last group of an attribute has zeros for what it lacks.
const uint k_tile_quads = 4;
const uint k_principal_head = 5;  // texels before the rows
const uint k_tensor_head = 9;
struct CurvatureTile {
    uint first_texel;
    uint first_group;  // of entries
    uint segment;
    uint unused;
};

struct ReprojectionParameters {
    vec4 low_scales;   // what the means of attributes 0 to 3 are multiplied with
    vec4 high_scales;  // and of 4 to 7
    uint first_tile;
    uint tiles;
    uint first_texel;  // with which what is bound begins
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
