#include "host/learn/regression/combine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"

namespace exemplar {

std::vector<double> predictor_weights(std::span<const double> residuals) {
    const std::size_t count = residuals.size();
    double largest = 0;
    for (std::size_t j = 0; j < count; ++j) {
        if (!(residuals[j] >= 0 && std::isfinite(residuals[j]))) {
            throw UsageError(fmt::format("predictor {} has a residual of {}, not a sum of squares", j, residuals[j]));
        }
        largest = std::max(largest, residuals[j]);
    }
    if (count <= 1 || largest == 0)
        return std::vector<double>(count, 1.0 / static_cast<double>(std::max<std::size_t>(count, 1)));
    double sum = 0;  // over the largest, so that it neither overflows nor vanishes
    for (const double residual : residuals) sum += residual / largest;
    std::vector<double> weights(count);
    for (std::size_t j = 0; j < count; ++j) {
        weights[j] = (1 - residuals[j] / largest / sum) / static_cast<double>(count - 1);
    }
    return weights;
}

}  // namespace exemplar
