#pragma once

#include <span>
#include <vector>

namespace exemplar {

/// Returns the median; NaN if there are no values.
double median(std::span<const double> values);

/// Returns the relative standard error of the median of normally distributed repeats. Their deviation is estimated
/// robustly, as 1.4826 times the median distance from the median. 0 if there are no values or the median is not
/// positive.
double relative_error(std::span<const double> values);

/// Ratio of a time to the time before.
struct Ratio {
    double value = 1;
    double error = 0;  ///< standard error of its logarithm
    /// Returns whether it takes longer by more than `errors` standard errors and by more than the share `least`.
    bool is_slower(double errors = 3, double least = 0.05) const;
    /// The same for shorter.
    bool is_faster(double errors = 3, double least = 0.05) const;
};

Ratio ratio_of(std::span<const double> now, std::span<const double> before);
/// Returns `ratio` divided by `drift`, the ratio of the whole machine.
Ratio without_drift(const Ratio& ratio, const Ratio& drift);
/// Returns the geometric mean of independent ratios; 1 if there are none.
Ratio mean_ratio(std::span<const Ratio> ratios);

}  // namespace exemplar
