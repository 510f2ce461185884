#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A labeled shape for the report page.
struct ShownShape {
    TriangleMesh mesh;
    FaceLabels labels;              ///< per triangle of `mesh`
    std::vector<float> confidence;  ///< per triangle, in [0, 1]
};

/// Reads a labeled mesh that a batch wrote (NAME.ply). If it has more than `max_faces` triangles, simplifies it to
/// about so many: each gets the label of largest area among the faces that it replaces, and their mean confidence.
/// Returns nothing if the file is missing, is not such a file, or cannot be simplified.
std::optional<ShownShape> read_shown_shape(const std::filesystem::path& path, std::size_t max_faces);

}  // namespace exemplar
