#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A division of the triangles of a mesh into named parts. Every part has a triangle; no two names are equal.
struct MeshParts {
    std::vector<std::string> names;
    std::vector<std::int32_t> labels;         ///< per part its label; -1 for unlabeled faces
    std::vector<std::uint32_t> part_of_face;  ///< per triangle
};

/// Makes a part of each label that occurs, in order of the names, with its name; then one named "unlabeled" of faces
/// without a label. `labels` are per source face. Throws UsageError if they do not fit the mesh.
MeshParts parts_by_label(const TriangleMesh& mesh, const FaceLabels& labels);

/// Makes a part of each connected piece of a label. A label of one piece keeps its name. If the mesh has
/// symmetry planes, that with most pairs is used: two pieces of a label that mirror each other (centers within 5 % of
/// the diagonal, areas within a quarter) are named `leg_left` and `leg_right`, with the number of the pair if there are
/// several: `leg_left_1`. Left is the side on which the largest component of the plane's normal grows: the left of a
/// figure that looks along +z with +y up, as glTF asks. Other pieces have numbers, `leg_1`, by decreasing area.
MeshParts parts_by_piece(const TriangleMesh& mesh, const FaceLabels& labels);

}  // namespace exemplar
