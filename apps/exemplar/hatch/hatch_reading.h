#pragma once

#include <filesystem>

#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/hatching/drawing/aligned_drawing.h"
#include "host/hatching/features/pixel_features.h"

namespace exemplar {

/// Reads a drawing of the view of `scene` and measures its strokes. Aligns it (prints the alignment unless `quiet`),
/// unless the view was found in it or the marks of its sheet tell where it lies. Throws DataError naming the file if it
/// cannot be read, is blank, or does not fit the view.
AlignedDrawing read_drawing(const std::filesystem::path& path, const HatchSceneArguments& scene,
                            const PixelFeatures& pixels, bool quiet);

/// Reads a drawing that shows exactly the view, at any resolution, and measures its strokes. Throws DataError naming
/// the file if it cannot be read or is blank, or if its aspect ratio is not the view's.
AlignedDrawing read_drawing_in_place(const std::filesystem::path& path, const PixelFeatures& pixels);

/// Reads a mask: returns the object's pixels that are lighter than medium gray in a picture of the view's size. Throws
/// DataError naming the file if it has another size or no such pixel.
PixelMask read_mask(const std::filesystem::path& path, const PixelFeatures& pixels);

}  // namespace exemplar
