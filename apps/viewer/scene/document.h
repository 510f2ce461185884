#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/animation/animation.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// A label with its color, as a legend shows it.
struct LegendEntry {
    std::string name;
    Color color{};
};

/// The opened file: a surface and its motions (see SurfaceFile). Labels are per polygon, the surface's source faces.
struct Document {
    std::filesystem::path path;
    Animation animation;
    std::vector<Color> face_colors;    ///< of labels, per face; empty without
    std::uint64_t colors_version = 1;  ///< increment it when face_colors are changed
    std::vector<LegendEntry> legend;
};

/// Reads a mesh (with the labels in it, in NAME_labels.txt or in NAME.seg beside it), an animation or a folder of
/// meshes. Errors in labels become warnings. Throws as read_surface.
Document read_document(const std::filesystem::path& path);

/// Colors the surface by a NAME_labels.txt or .seg file. Throws DataError if it does not fit the surface.
void add_labels(Document& document, const std::filesystem::path& path);

}  // namespace exemplar
