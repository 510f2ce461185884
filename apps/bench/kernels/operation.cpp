#include "apps/bench/kernels/operation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace exemplar {

const std::vector<OperationKind>& operation_kinds() {
    static const std::vector<OperationKind> all = [] {
        std::vector<OperationKind> kinds;
        for (auto* const of_subject :
             {runtime_operations, learn_operations, labeling_operations, imaging_operations, curvature_operations,
              learned_curvature_operations, line_operations, hatching_operations})
            for (OperationKind& kind : of_subject()) kinds.push_back(std::move(kind));
        return kinds;
    }();
    return all;
}

double largest_difference(std::span<const float> actual, std::span<const float> expected) {
    constexpr double k_infinite = std::numeric_limits<double>::infinity();
    if (actual.size() != expected.size()) return k_infinite;
    double largest = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (actual[i] == expected[i]) continue;
        const double apart = std::abs(static_cast<double>(actual[i]) - static_cast<double>(expected[i]));
        largest = std::isnan(apart) ? k_infinite : std::max(largest, apart);
    }
    return largest;
}

}  // namespace exemplar
