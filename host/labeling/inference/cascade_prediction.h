#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// Below, a sum of probabilities counts as zero.
constexpr float k_no_probability = 1e-30F;

/// Copies the probabilities of the classes `taken` from `source` to `target`, for each item. The other classes share
/// the rest in their previous proportions, or equally if they had nothing. Both are items x classes.
void copy_class_probabilities(std::span<const std::uint32_t> taken, std::size_t classes, std::span<const float> source,
                              std::span<float> target);

/// The prediction of a cascade after each of its stages: that of its last classifier, except for the `averaged`
/// classes, whose probability is the mean over all stages so far. Those are labels that training saw in one fold only:
/// later stages forget them, as out-of-fold context does not show them as they are (see train_labeling).
class CascadePrediction {
  public:
    CascadePrediction(std::span<const std::uint32_t> averaged, std::size_t classes)
        : averaged_(averaged.begin(), averaged.end()), classes_(classes) {}
    /// Turns the probabilities of the next stage, items x classes, into the prediction of the cascade.
    void add_stage(std::span<float> probabilities);

  private:
    std::vector<std::uint32_t> averaged_;
    std::size_t classes_;
    std::vector<float> mean_;  ///< of the stages so far
    float stages_ = 0;
};

}  // namespace exemplar
