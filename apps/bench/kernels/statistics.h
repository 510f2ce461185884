#pragma once

#include <span>
#include <vector>

namespace exemplar {

/// The median; NaN of nothing.
double median(std::span<const double> values);

/// How uncertain the median of repeats is, as a share of it: its standard error for normally distributed repeats, of a
/// deviation that a few stray ones do not change (1.4826 times the median distance from the median). NaN of nothing.
double relative_error(std::span<const double> values);

/// How many times as long something takes as before.
struct Ratio {
    double value = 1;
    double error = 0;  ///< standard error of its logarithm
    /// Whether it takes longer beyond what `errors` standard errors explain, and by more than `least`.
    bool is_slower(double errors = 3, double least = 0.05) const;
    /// The same of shorter.
    bool is_faster(double errors = 3, double least = 0.05) const;
};

Ratio ratio_of(std::span<const double> now, std::span<const double> before);
/// The ratio that is left of `ratio` when the whole machine has become `drift` times as slow.
Ratio without_drift(const Ratio& ratio, const Ratio& drift);
/// The geometric mean of independent ratios; 1 of none.
Ratio mean_ratio(std::span<const Ratio> ratios);

}  // namespace exemplar
