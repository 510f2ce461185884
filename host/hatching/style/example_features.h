#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/hatching/rules/hatching_examples.h"
#include "host/hatching/style/hatching_style.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// The numbers from `first` up to `end`, without it.
std::vector<std::uint32_t> numbers_from(std::size_t first, std::size_t end);

/// The probabilities of segments that contextual features are computed from: rows x segments, of all rows.
struct SegmentContext {
    std::size_t segments = 0;
    std::span<const float> probabilities;
};

/// Scalar features of drawn views, with contextual ones if they are asked for, and what classifiers make of them.
class ExampleFeatures {
  public:
    /// Keeps references.
    ExampleFeatures(const HatchingExamples& views, StumpScorer& scorer) : views_(views), scorer_(scorer) {}

    /// Returns all base features of rows, and after them contextual features unless there are fewer than two segments.
    FeatureMatrix of_rows(std::span<const std::uint32_t> rows, const SegmentContext& context) const;

    /// Returns, for each classifier, its probabilities for all rows: rows x classes.
    std::vector<std::vector<float>> probabilities(std::span<const CalibratedStumps> classifiers,
                                                  const SegmentContext& context) const;
    std::vector<float> probabilities(const CalibratedStumps& classifier, const SegmentContext& context) const {
        return std::move(probabilities(std::span(&classifier, 1), context).front());
    }

    /// Returns the values of a view's rows, of which each has so many.
    template <typename Value>
    std::span<const Value> of_view(std::size_t view, std::span<const Value> values, std::size_t per_row) const {
        return values.subspan(views_.first_row(view) * per_row, views_.views()[view].pixels.size() * per_row);
    }

  private:
    FeatureMatrix context_of_view(std::size_t view, std::span<const std::uint32_t> rows,
                                  const SegmentContext& context) const;
    FeatureMatrix context_of_rows(std::span<const std::uint32_t> rows, const SegmentContext& context) const;

    const HatchingExamples& views_;
    StumpScorer& scorer_;
};

}  // namespace exemplar
