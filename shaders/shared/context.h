#ifndef EXEMPLAR_SHARED_CONTEXT_H
#define EXEMPLAR_SHARED_CONTEXT_H
#include "shaders/shared/types.h"

SHARED_BEGIN

const uint k_context_bins = 5;  // distance ranges
const uint k_context_axes = 6;
// Samples per texel of ranges, four bits each.
const uint k_context_sample_block = 32;
// Classes per texel of masses.
const uint k_context_class_block = 4;

// Samples are summed in so many runs at a time.
const uint k_prefix_runs = 64;

// The values of LinearClassifier::k_max_deviations, and of k_min_combined_probability and k_no_probability of
// host/labeling/inference.
const float k_max_deviations = 2.0f;
const float k_min_combined_probability = 1e-6f;
const float k_no_probability = 1e-30f;

// A mesh, or a part of one: some of its samples, faces and classes; and where its own begin in buffers that hold
// several parts, in elements of these.
struct ContextPart {
    vec4 edges[k_context_axes];  // inner bin edges of each axis, rising
    uint faces;
    uint samples;
    uint classes;
    uint first_class;     // of the probabilities
    uint first_face;      // the positions, axes x faces, begin at axes x first_face
    uint first_sample;    // of the samples; the tables by axis, axes x samples, begin at axes x first_sample
    uint ranges;          // sample blocks x faces
    uint masses;          // class blocks x samples, padded to whole sample blocks
    uint prefixes;        // axes x class blocks x (samples + 1)
    uint first_geodesic;  // column 0 of the histograms over geodesic distance, of the first face
    uint first_axes;      // the same along axes
    uint stride;          // between columns of histograms
};

// A face that represents the surface.
struct ContextSample {
    uint row;  // of the probabilities
    float area;
};

// A contextual column that a classifier compares with thresholds.
struct RankedColumn {
    uint source;  // column of the histograms
    uint target;  // column of the ranks
    uint first;   // of the thresholds, in groups of four
    uint groups;
};

struct MassParameters {
    uint classes;  // of a row of probabilities
};

struct RankParameters {
    uint rows;            // a multiple of four; also the stride between columns
    uint geodesic_count;  // columns of the histograms over geodesic distance; those along axes follow
};

struct LinearParameters {
    uint rows;  // also the stride between columns
    uint classes;
    uint threads;  // invocations along x that have work
};

struct PredictionParameters {
    uint rows;
    uint combines;  // 1: combines the stumps with a linear classifier
    float ratio;
    float scale;
    float stages;        // of the cascade so far, with this one
    uint averaged_low;   // bit c: class c is averaged over the stages
    uint averaged_high;  // bit c - 32
};

#ifdef __cplusplus
EXEMPLAR_LAYOUT(ContextPart, edges, faces, samples, classes, first_class, first_face, first_sample, ranges, masses,
                prefixes, first_geodesic, first_axes, stride)
EXEMPLAR_LAYOUT(ContextSample, row, area)
EXEMPLAR_LAYOUT(RankedColumn, source, target, first, groups)
EXEMPLAR_LAYOUT(MassParameters, classes)
EXEMPLAR_LAYOUT(RankParameters, rows, geodesic_count)
EXEMPLAR_LAYOUT(LinearParameters, rows, classes, threads)
EXEMPLAR_LAYOUT(PredictionParameters, rows, combines, ratio, scale, stages, averaged_low, averaged_high)
#endif

SHARED_END
#endif
