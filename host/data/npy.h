#pragma once

#include <filesystem>

#include "host/learn/feature_matrix.h"

namespace exemplar {

/// Writes a matrix as NumPy's .npy, format 1.0: a C-order array of little-endian float32, items x features. Column
/// names are not part of the format. Throws DataError if it cannot be written.
void write_npy(const std::filesystem::path& path, const FeatureMatrix& matrix);

}  // namespace exemplar
