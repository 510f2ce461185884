#include "host/learn/boosting/training_pairs.h"

#include <cmath>
#include <numeric>
#include <string>

#include "host/core/errors.h"

namespace exemplar {

std::vector<std::uint32_t> used_rows(std::span<const std::uint32_t> rows, std::size_t row_count) {
    std::vector<std::uint32_t> out(rows.begin(), rows.end());
    if (rows.empty()) {
        out.resize(row_count);
        std::iota(out.begin(), out.end(), 0u);
    }
    for (const std::uint32_t row : out) {
        if (row >= row_count) {
            throw UsageError("row " + std::to_string(row) + " was chosen, but there are " + std::to_string(row_count));
        }
    }
    return out;
}

void check_pairs(std::span<const std::uint32_t> rows, std::size_t row_count, std::span<const std::int32_t> labels,
                 std::span<const float> weights, std::size_t class_count) {
    if (labels.size() != row_count || (weights.size() != row_count && weights.size() != row_count * class_count)) {
        throw UsageError("there are " + std::to_string(labels.size()) + " labels and " +
                         std::to_string(weights.size()) + " weights for " + std::to_string(row_count) + " rows of " +
                         std::to_string(class_count) +
                         " classes; give one label per row and one weight per row, or per row and class");
    }
    const std::size_t per_row = weights.size() == row_count ? 1 : class_count;
    double total = 0.0;
    for (const std::uint32_t row : rows) {
        if (labels[row] < 0 || static_cast<std::size_t>(labels[row]) >= class_count) {
            throw UsageError("row " + std::to_string(row) + " has label " + std::to_string(labels[row]) +
                             ", but labels are 0 to " + std::to_string(class_count - 1) + "; leave such rows out");
        }
        for (const float weight : weights.subspan(row * per_row, per_row)) {
            if (!(weight >= 0.0f) || std::isinf(weight)) {
                throw DataError("row " + std::to_string(row) + " has the weight " + std::to_string(weight) +
                                "; weights must be finite and not negative");
            }
            total += static_cast<double>(weight);
        }
    }
    if (total <= 0.0) throw DataError("all weights are zero; there is nothing to learn from");
}

}  // namespace exemplar
