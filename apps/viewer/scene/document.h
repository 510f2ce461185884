#pragma once

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

/// The opened file: a surface and its motions. A single mesh is a sequence without clips.
struct Document {
    std::filesystem::path path;
    Animation animation;
    /// For each face of the surface, the polygon of the file that it is a part of. Labels are per polygon.
    std::vector<std::uint32_t> source_face;
    std::size_t source_face_count = 0;
    std::vector<Color> face_colors;  ///< of labels; empty without
    std::vector<LegendEntry> legend;
    std::vector<std::string> remarks;  ///< what was repaired or left out, a line each

    bool posable() const { return animation.kind != AnimationKind::sequence; }
    bool moves() const { return posable() || animation.frame_count() > 0; }
};

/// Reads a mesh (with the labels in it, in NAME_labels.txt or in NAME.seg beside it), an animation or a folder of
/// meshes. Throws MeshError or DataError with a message of one line.
Document read_document(const std::filesystem::path& path);

/// Colors the surface by a NAME_labels.txt or .seg file. Throws DataError if it does not fit the surface.
void add_labels(Document& document, const std::filesystem::path& path);

}  // namespace exemplar
