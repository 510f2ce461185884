#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace exemplar {

/// The rows named, or all of them. Throws UsageError for an index out of range.
std::vector<std::uint32_t> used_rows(std::span<const std::uint32_t> rows, std::size_t row_count);

/// Checks labels and weights of the rows used: UsageError for sizes and labels, DataError for weights.
void check_pairs(std::span<const std::uint32_t> rows, std::size_t row_count, std::span<const std::int32_t> labels,
                 std::span<const float> weights, std::size_t class_count);

}  // namespace exemplar
