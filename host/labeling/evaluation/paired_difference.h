#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace exemplar {

/// The scores of two methods differ by so much on one mesh.
struct PairedDifference {
    std::string category;
    std::string mesh;  ///< a mesh may be measured more than once, after different trainings
    double value = 0;
};

struct DifferenceEstimate {
    double mean = 0;                 ///< mean over the categories of the means over their differences
    double lowest = 0, highest = 0;  ///< 95 % interval
};

/// Returns the mean over the categories of the means over their values; NaN without values.
double mean_over_categories(std::span<const PairedDifference> values);

/// Estimates the difference of two methods from the same meshes. The interval is that of a bootstrap (Efron 1979,
/// percentiles of 2,000 resamples): within each category, meshes are drawn with replacement, each with all its
/// differences. Equal seeds give equal intervals. Returns NaN without differences.
DifferenceEstimate estimate_difference(std::span<const PairedDifference> differences, std::uint64_t seed = 1);

}  // namespace exemplar
