#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "host/learn/feature_matrix.h"

namespace exemplar {

/// Writes a matrix as NumPy's .npy, format 1.0: a C-order array of little-endian float32, items x features. Column
/// names are not part of the format. If `row_of` is given, item i of the array is row row_of[i] of the matrix.
/// Throws DataError if it cannot be written.
void write_npy(const std::filesystem::path& path, const FeatureMatrix& matrix,
               std::span<const std::uint32_t> row_of = {});

}  // namespace exemplar
