#ifndef EXEMPLAR_SHARED_CONTEXT_H
#define EXEMPLAR_SHARED_CONTEXT_H
#include "shaders/shared/types.h"

SHARED_BEGIN

const uint k_context_bins = 5;  // distance ranges
const uint k_context_axes = 6;
// Samples per texel of ranges, one byte each.
const uint k_context_sample_block = 16;
// Classes per texel of masses.
const uint k_context_class_block = 4;

struct GeodesicContextParameters {
    uint faces;          // of the tile; also the stride between output columns
    uint sample_blocks;  // of k_context_sample_block samples
    uint classes;
    uint threads;  // invocations along x that have work
};

struct AxisContextParameters {
    vec4 edges[k_context_axes];  // inner bin edges of each axis, rising
    uint faces;
    uint samples;
    uint classes;
    uint padding;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(GeodesicContextParameters, faces, sample_blocks, classes, threads)
EXEMPLAR_LAYOUT(AxisContextParameters, edges, faces, samples, classes, padding)
#endif

SHARED_END
#endif
