#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/hatching/style/example_folds.h"

namespace exemplar {

/// Rows whose segment is known.
struct SegmentTraining {
    std::span<const std::uint32_t> rows;
    std::span<const std::int32_t> segment;   ///< per row
    std::span<const std::uint8_t> held_out;  ///< per row, 1: decides when boosting stops
    std::size_t segments = 1;                ///< number of different segments
    std::size_t max_stages = 3;
    std::uint64_t seed = 1;
};

struct LearnedSegments {
    std::vector<CalibratedStumps> cascade;  ///< all but the first also use contextual features
    std::vector<double> errors;             ///< share of held-out rows that are wrong, per stage that was tried
    /// Probabilities of all rows of the views, rows x segments: by the cascade, and by classifiers that have learned
    /// from other parts of the picture only. What is learned from rows must take its context from the latter: a
    /// classifier is surer of the rows that it has learned from than it will be of another drawing's.
    std::vector<float> probabilities, unseen;
};

/// Learns to tell segments by a cascade of classifiers (thesis Sec. 4.4.2): each stage is also given the mean
/// probabilities of segments around a pixel (Eq. 4.15), as the stage before would see pixels that it did not learn
/// from. A stage whose held-out rows are told no better ends the cascade, and is not kept.
LearnedSegments learn_segments(const ExampleFeatures& features, const ExampleFolds& folds,
                               const SegmentTraining& training, const std::function<void()>& progress);

}  // namespace exemplar
