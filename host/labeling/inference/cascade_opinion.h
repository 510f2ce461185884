#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// Gives some classes of each item the probabilities that `source` has for them; the others share the rest as they did,
/// equally if they had nothing.
/// Both: items x classes.
void take_classes(std::span<const std::uint32_t> taken, std::size_t classes, std::span<const float> source,
                  std::span<float> target);

/// What a cascade says after each of its stages: what its last classifier says, but for the `averaged` classes the mean
/// of what all have said. Those are labels that training saw in one fold alone: out-of-fold context does not show them
/// as they are, so later stages forget them (see train_labeling).
class CascadeOpinion {
  public:
    CascadeOpinion(std::span<const std::uint32_t> averaged, std::size_t classes)
        : averaged_(averaged.begin(), averaged.end()), classes_(classes) {}
    /// Turns the probabilities of the next stage, items x classes, into what the cascade says.
    void add_stage(std::span<float> probabilities);

  private:
    std::vector<std::uint32_t> averaged_;
    std::size_t classes_;
    std::vector<float> mean_;  ///< of the stages so far
    float stages_ = 0;
};

}  // namespace exemplar
