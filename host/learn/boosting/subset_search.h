#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

/// Weight sums of one feature's splits, per candidate class: S = sum of z w and W = sum of w, below and above each
/// threshold. Arrays are classes x stride, with zeros after the last threshold.
struct SplitSums {
    std::size_t classes = 0;
    std::size_t stride = 0;  ///< thresholds, rounded up to a multiple of 8
    std::vector<float> below_s, below_w, above_s, above_w;
    std::vector<float> constant_gain;  ///< per class: S^2 / W of all rows, the gain of its own constant k_c

    void resize(std::size_t class_count, std::size_t thresholds);
};

/// The best threshold and subset of classes. The gain is S_b^2 / W_b + S_a^2 / W_a, with S and W first summed over
/// the subset, minus the subset's constant gains. Bit c of the subset is class c of the sums. The subset is empty
/// (0) if no gain exceeds the floor.
struct SubsetChoice {
    float gain = 0;
    std::uint32_t threshold = 0;
    std::uint64_t subset = 0;
};

/// Maximum number of classes for best_subset_exhaustive.
constexpr std::size_t k_max_exhaustive_classes = 10;
/// Tries all subsets. Skips thresholds that cannot gain more than `floor`: a subset that shares a and b gains at
/// most what its classes would gain with an a and b of their own.
SubsetChoice best_subset_exhaustive(const SplitSums& sums, float floor = 0);

/// For each threshold, adds the class that gains most to the subset until it holds all, and takes the best subset on
/// the way.
SubsetChoice best_subset_greedy(const SplitSums& sums, float floor = 0);

}  // namespace exemplar
