#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace exemplar {

/// The weight sums of one feature's splits, per candidate class: S = sum of z w and W = sum of w below and above each
/// threshold. Arrays are classes x stride, with zeros after the last threshold.
struct SplitSums {
    std::size_t classes = 0;
    std::size_t stride = 0;  ///< thresholds, rounded up to a multiple of 8
    std::vector<float> below_s, below_w, above_s, above_w;
    std::vector<float> constant_gain;  ///< per class: S^2 / W of all rows, what its own constant k_c gains

    void resize(std::size_t class_count, std::size_t thresholds);
};

/// The best threshold and subset of classes: gain = S_b^2 / W_b + S_a^2 / W_a, summed over the subset first, less the
/// subset's constant gains. Subset bit c is class c of the sums. No subset (0) if nothing gains more than the floor.
struct SubsetChoice {
    float gain = 0;
    std::uint32_t threshold = 0;
    std::uint64_t subset = 0;
};

/// Tries all subsets; at most k_most_exhaustive classes. Thresholds that cannot gain more than `floor` are passed over:
/// a subset that shares a and b gains at most what its classes gain with an a and b of their own.
constexpr std::size_t k_most_exhaustive = 10;
SubsetChoice best_subset_exhaustive(const SplitSums& sums, float floor = 0);

/// For each threshold grows the subset by the class that gains most until it holds all, and takes the best on the way.
SubsetChoice best_subset_greedy(const SplitSums& sums, float floor = 0);

}  // namespace exemplar
