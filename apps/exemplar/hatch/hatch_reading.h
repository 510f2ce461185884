#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/exemplar/hatch/hatch_scene.h"
#include "host/hatching/drawing/aligned_drawing.h"
#include "host/hatching/features/pixel_features.h"

namespace exemplar {

/// A file with a drawing.
struct DrawingFile {
    std::filesystem::path path;
    std::size_t page = 0;  ///< of a TIFF with several, from 1; 0: it has one
};
/// Adds --page; for several drawings, one each in the order that `drawings` tells.
void add_page_option(Command& command, std::size_t& page);
void add_page_option(Command& command, std::vector<std::size_t>& pages, const std::string& drawings);
/// Returns the page of a drawing; 0 if none was given for it.
std::size_t page_of(const std::vector<std::size_t>& pages, std::size_t drawing);

/// Reads a drawing of the view of `scene` and measures its strokes. Aligns it (prints the alignment unless `quiet`),
/// unless the view was found in it or the marks of its sheet tell where it lies. The strokes of an SVG are measured as
/// they are. Throws DataError naming the file if it cannot be read, is blank, or does not fit the view.
AlignedDrawing read_drawing(const DrawingFile& file, const HatchSceneArguments& scene, const PixelFeatures& pixels,
                            bool quiet);

/// Reads a drawing that shows exactly the view, at any resolution, and measures its strokes. Throws DataError naming
/// the file if it cannot be read or is blank, or if its aspect ratio is not the view's.
AlignedDrawing read_drawing_in_place(const DrawingFile& file, const PixelFeatures& pixels);

/// Returns the darkness of a drawing (drawing_darkness) at its own size; of an SVG, with `largest_side` pixels along
/// the longer side. Throws DataError naming the file if it cannot be read or is blank.
FloatImage read_darkness(const DrawingFile& file, int largest_side);

/// Reads a mask: returns the object's pixels that are lighter than medium gray in a picture of the view's size. Throws
/// DataError naming the file if it has another size or no such pixel.
PixelMask read_mask(const std::filesystem::path& path, const PixelFeatures& pixels);

}  // namespace exemplar
