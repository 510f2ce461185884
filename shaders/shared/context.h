#ifndef EXEMPLAR_SHARED_CONTEXT_H
#define EXEMPLAR_SHARED_CONTEXT_H
#include "shaders/shared/types.h"

SHARED_BEGIN

struct GeodesicContextParameters {
    uint faces;          // of the tile, also the distance from one output column to the next
    uint sample_blocks;  // of k_context_sample_block samples
    uint classes;
    uint threads;  // invocations along x that have work
};

// Samples whose ranges one texel holds, a byte each.
const uint k_context_sample_block = 16;

struct AxisContextParameters {
    vec4 edges[6];  // per axis the inner bin edges, rising
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
