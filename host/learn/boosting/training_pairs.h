#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// Returns `rows`, or all rows if it is empty. Throws UsageError for an index out of range.
std::vector<std::uint32_t> used_rows(std::span<const std::uint32_t> rows, std::size_t row_count);

/// Checks labels and weights of the used rows. Throws UsageError for wrong sizes and labels, DataError for wrong
/// weights.
void check_pairs(std::span<const std::uint32_t> rows, std::size_t row_count, std::span<const std::int32_t> labels,
                 std::span<const float> weights, std::size_t class_count);

}  // namespace exemplar
