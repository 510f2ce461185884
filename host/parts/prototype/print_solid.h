#pragma once

#include <string>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A solid to print.
struct PrintSolid {
    std::string name;
    TriangleMesh mesh;  ///< closed and manifold, in mm, in the frame of the print
};

/// Returns the mesh with equal vertices joined. Throws MeshError if it is not closed or not usable.
TriangleMesh closed_for_print(const TriangleMesh& mesh);

/// Removes connected pieces of less than 2 % of the volume of the largest, which are crumbs of the grid. Closed
/// surfaces stay closed.
TriangleMesh without_crumbs(const TriangleMesh& mesh);

}  // namespace exemplar
