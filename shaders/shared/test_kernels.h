#ifndef EXEMPLAR_SHARED_TEST_KERNELS_H
#define EXEMPLAR_SHARED_TEST_KERNELS_H
#include "shaders/shared/types.h"

// Structures of the kernels that only the tests of gpu/runtime use.
SHARED_BEGIN

struct AffineParameters {
    uint count;
    float factor;
    float summand;
};

struct Particle {
    vec4 position;
    float mass;
    uint id;
    vec2 padding;
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(AffineParameters, count, factor, summand)
EXEMPLAR_LAYOUT(Particle, position, mass, id, padding)
#endif

SHARED_END
#endif
