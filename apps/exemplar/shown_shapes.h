#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A labeled shape as a page shows it.
struct ShownShape {
    TriangleMesh mesh;
    FaceLabels labels;              ///< per triangle of `mesh`
    std::vector<float> confidence;  ///< the same, in [0, 1]
};

/// Reads back what a batch has written (NAME.ply) and, if it has more than `most_faces` triangles, simplifies it to
/// about so many: a face takes the label that has the most area among those it stands for, and their mean confidence.
/// Nothing if the file is not there, is no such file, or cannot be simplified.
std::optional<ShownShape> read_shown_shape(const std::filesystem::path& path, std::size_t most_faces);

}  // namespace exemplar
