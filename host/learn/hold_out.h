#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/jointboost.h"

namespace exemplar {

/// Follows a classifier on held-out pairs as it grows by one stump after another.
class HoldOut {
  public:
    /// Keeps references to the data of `set`. `gentle`: two classes of which only class 1 counts in the loss.
    HoldOut(const ValidationSet& set, std::size_t class_count, bool gentle);
    /// Adds a stump and its k_c; writes the validation loss and error into `round`.
    void add(const Stump& stump, std::span<const float> elsewhere, BoostRound& round);

  private:
    struct Measure {
        double loss = 0, error = 0;
    };
    Measure add_to_rows(const Stump& stump, std::span<const float> elsewhere, std::size_t begin, std::size_t end);
    double initial_weight(std::size_t item, std::size_t c) const;

    ValidationSet set_;
    std::vector<std::uint32_t> rows_;
    std::size_t classes_, first_;
    std::vector<double> h_;       ///< rows x classes: H
    std::vector<double> weight_;  ///< rows x classes: w exp(-z H)
    double total_ = 0, label_total_ = 0;
};

/// The rows named, or all of them. Throws UsageError for an index out of range.
std::vector<std::uint32_t> used_rows(std::span<const std::uint32_t> rows, std::size_t row_count);

/// Checks labels and weights of the rows used: UsageError for sizes and labels, DataError for weights.
void check_pairs(std::span<const std::uint32_t> rows, std::size_t row_count, std::span<const std::int32_t> labels,
                 std::span<const float> weights, std::size_t class_count);

}  // namespace exemplar
