#ifndef EXEMPLAR_SHARED_STUMPS_H
#define EXEMPLAR_SHARED_STUMPS_H
#include "shaders/shared/types.h"

SHARED_BEGIN

// One decision stump, without its classes.
struct GroupedStump {
    uint column;     // of the uploaded features
    uint threshold;  // bits of a float; or of ranks: a signed number that the words of ranks above the threshold exceed
    float above;
    float below;
};

// Stumps [first, end) share one set of classes: bit c of low, or c - 32 of high.
struct StumpGroup {
    uint first;
    uint end;
    uint classes_low;
    uint classes_high;
};

struct StumpParameters {
    uint rows;
    uint stride;       // groups of four words between feature columns; at least those of all threads
    uint threads;      // invocations that have work, a multiple of k_stump_neighbors
    uint first_group;  // this dispatch adds groups [first_group, end_group)
    uint end_group;
    uint groups;  // total over all dispatches
    uint link;    // k_link_softmax or k_link_sigmoid
    float scale;
};

// The values of exemplar::Link.
const uint k_link_softmax = 0;
const uint k_link_sigmoid = 1;

// Number of consecutive invocations that read neighboring texels.
const uint k_stump_neighbors = 8;

#ifdef __cplusplus
EXEMPLAR_LAYOUT(GroupedStump, column, threshold, above, below)
EXEMPLAR_LAYOUT(StumpGroup, first, end, classes_low, classes_high)
EXEMPLAR_LAYOUT(StumpParameters, rows, stride, threads, first_group, end_group, groups, link, scale)
#endif

SHARED_END
#endif
