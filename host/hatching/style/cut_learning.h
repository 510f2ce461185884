#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "host/hatching/style/example_features.h"
#include "host/hatching/style/pixel_crf.h"

namespace exemplar {

/// Labels of rows, and what classifiers that have not learned from these rows say of them.
struct CutTraining {
    std::span<const float> probabilities;  ///< rows of all views x classes
    std::size_t classes = 2;
    std::span<const std::uint32_t> rows;  ///< those whose labels decide
    std::span<const std::int32_t> labels;
};

/// The graphs of drawn views, which labels are cut from.
class ExampleCuts {
  public:
    /// Keeps references. `boundary`: P(e | x) of all rows.
    ExampleCuts(const HatchingExamples& views, const ExampleFeatures& features, std::span<const float> boundary);

    /// Returns the label of each row.
    std::vector<std::int32_t> solve(std::span<const float> probabilities, std::size_t classes,
                                    const PixelCrfParameters& parameters);

    /// Returns the parameters of the weakest cut of a grid whose share of wrong labels is within a standard error of
    /// the smallest: what is cut into a held-out patch from around it makes strong cuts look better than they will be
    /// in another view. The thesis selects those by which boundaries between labels agree best with P(e | x)
    /// (Eq. 4.16). Of a drawing by hand P(e | x) often tells nothing: it is a half everywhere, and the agreement is
    /// noise.
    PixelCrfParameters learn(const CutTraining& training, const std::function<void()>& progress);

  private:
    const ExampleFeatures& features_;
    std::vector<PixelCrf> cuts_;  // one per view
};

}  // namespace exemplar
