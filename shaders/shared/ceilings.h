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

// Of the kernels that read or count the same places again and again.
struct RoundParameters {
    uint rounds;
};

const uint k_multiply_adds_per_round = 8 * 4;  // eight chains of vec4
const uint k_shared_vectors = 256;
const uint k_texels_read = 1024;
const uint k_reads_per_round = 8;  // of shared memory, or texels

#ifdef __cplusplus
EXEMPLAR_LAYOUT(CopyParameters, count)
EXEMPLAR_LAYOUT(MultiplyAddParameters, rounds, factor, summand)
EXEMPLAR_LAYOUT(RoundParameters, rounds)
#endif

SHARED_END
#endif
