#pragma once

#include <filesystem>

#include "host/hatching/features/pixel_features.h"
#include "host/hatching/measurement/stroke_measurements.h"

namespace exemplar {

/// Reads a drawing of a view, aligns it (prints the alignment unless `quiet`), and measures its strokes. Throws
/// DataError naming the file if it cannot be read, is blank, or does not fit the view.
StrokeMeasurements read_drawing(const std::filesystem::path& path, const PixelFeatures& pixels, bool quiet);

}  // namespace exemplar
