#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/labels.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Returns per vertex the label with the largest sum of corner angles; the lower one of equals. -1 for vertices of no
/// labeled face. `face_label` is per source face.
std::vector<std::int32_t> labels_of_vertices(const TriangleMesh& mesh, std::span<const std::int32_t> face_label);

/// Returns per source face the label of most of its corners; if several labels have equally many, the one with the
/// larger sum of corner angles. Corners without a label (-1) do not count; a face without labeled corners gets -1.
std::vector<std::int32_t> labels_of_faces(const TriangleMesh& mesh, std::span<const std::int32_t> vertex_label);

}  // namespace exemplar
