#ifndef EXEMPLAR_SHARED_CEILINGS_H
#define EXEMPLAR_SHARED_CEILINGS_H
#include "shaders/shared/types.h"

SHARED_BEGIN

struct CopyParameters {
    uint count;  // vec4s to copy
};

struct MultiplyAddParameters {
    uint rounds;  // of k_multiply_adds_per_round each
    float factor;
    float summand;
};

const uint k_multiply_adds_per_round = 8 * 4;  // eight chains of vec4

#ifdef __cplusplus
EXEMPLAR_LAYOUT(CopyParameters, count)
EXEMPLAR_LAYOUT(MultiplyAddParameters, rounds, factor, summand)
#endif

SHARED_END
#endif
