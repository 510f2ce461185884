#ifndef EXEMPLAR_SHARED_CONTEXT_H
#define EXEMPLAR_SHARED_CONTEXT_H
#include "shaders/shared/types.h"

SHARED_BEGIN

struct GeodesicContextParameters {
    vec4 edges;  // inner bin edges, rising
    uint faces;  // of the tile, also the distance from one output column to the next
    uint samples;
    uint classes;
    uint padding;
};

struct AxisContextParameters {
    vec4 edges[6];  // per axis
    uint faces;
    uint samples;
    uint classes;
    uint padding;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(GeodesicContextParameters, edges, faces, samples, classes, padding)
EXEMPLAR_LAYOUT(AxisContextParameters, edges, faces, samples, classes, padding)
#endif

SHARED_END
#endif
