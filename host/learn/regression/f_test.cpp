#include "host/learn/regression/f_test.h"

#include <fmt/format.h>

#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>

#include "host/core/errors.h"

namespace exemplar {
namespace {

constexpr double k_rounding = 1e-20;

void check_models(double residual_small, std::size_t parameters_small, double residual_full,
                  std::size_t parameters_full) {
    for (const double residual : {residual_small, residual_full}) {
        if (residual >= 0 && std::isfinite(residual)) continue;
        throw UsageError(fmt::format("a residual of {} is not a sum of squares", residual));
    }
    if (parameters_full >= parameters_small) return;
    throw UsageError(fmt::format("the larger model has {} parameters, the smaller one {}; give the smaller one first",
                                 parameters_full, parameters_small));
}

}  // namespace

FTest f_test(double residual_small, std::size_t parameters_small, double residual_full, std::size_t parameters_full,
             std::size_t samples, double scale) {
    check_models(residual_small, parameters_small, residual_full, parameters_full);
    const double gain = residual_small - residual_full;  // below 0 only by rounding
    if (samples <= parameters_full || parameters_full == parameters_small || !(gain > 0)) return {};
    if (residual_small <= k_rounding * scale) return {};
    const auto added = static_cast<double>(parameters_full - parameters_small);
    const auto left = static_cast<double>(samples - parameters_full);
    const double statistic = (gain / added) / (residual_full / left);
    if (residual_full <= k_rounding * std::fmax(scale, residual_small) || !std::isfinite(statistic)) {
        return {std::numeric_limits<double>::infinity(), 0};
    }
    const boost::math::fisher_f distribution(added, left);
    return {statistic, boost::math::cdf(boost::math::complement(distribution, statistic))};
}

}  // namespace exemplar
