#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "host/labeling/painting/painted_labels.h"

namespace exemplar {

/// The painted labels of one mesh that is not verified yet, and their palette.
struct Painting {
    std::vector<PaletteEntry> palette;
    std::vector<std::int32_t> label;  ///< per face: an index into the palette, or k_unpainted
};

/// Returns the file that keeps the strokes of a mesh until its labels are verified: NAME_painting.json beside it.
std::filesystem::path painting_path(const std::filesystem::path& mesh);

/// Writes a painting, so that readers never see half of it. Throws DataError if it cannot be written.
void save_painting(const std::filesystem::path& path, const Painting& painting);

/// Reads a painting of a mesh with so many faces. Throws DataError with the file and the place if it is damaged or of
/// another mesh.
Painting load_painting(const std::filesystem::path& path, std::size_t faces);

/// Returns the name of a label without spaces at its ends. Throws UsageError if it is empty, longer than 100 bytes, or
/// has characters that label files cannot hold (line breaks and other control characters).
std::string checked_label_name(const std::string& name);

}  // namespace exemplar
