#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/hatching/style/example_features.h"
#include "host/hatching/style/pixel_classifier.h"

namespace exemplar {

/// Drawn views, divided into blocks that are dealt to four folds, to classify each pixel by what the rest of the
/// picture teaches: no neighbor of a pixel tells its label.
class ExampleFolds {
  public:
    /// Keeps references.
    ExampleFolds(const HatchingExamples& views, const ExampleFeatures& features, std::uint64_t seed);

    /// Returns the probabilities of all rows of the views, rows x classes, by classifiers that have not learned from
    /// the row's fold, and else are as `like`: they have as many rounds and the same link. `rows` are the rows of
    /// `training`; `first_feature` is the number of its first base feature.
    std::vector<float> unseen_probabilities(const ClassifierTraining& training, std::span<const std::uint32_t> rows,
                                            const CalibratedStumps& like, const SegmentContext& context,
                                            const std::function<void()>& progress, std::size_t first_feature = 0) const;

  private:
    const ExampleFeatures& features_;
    std::vector<std::uint8_t> fold_;  // per row
};

}  // namespace exemplar
