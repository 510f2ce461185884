#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// The place where one component of a mesh is nearest to another, larger one.
struct PieceContact {
    std::uint32_t face = 0;        ///< of the component
    std::uint32_t other_face = 0;  ///< of the larger one
    Vec3 point;                    ///< between the centers of the two faces
};

/// Returns a contact for each component but the largest (by area, then by first face): with one of up to 16 larger
/// ones, by the distance between the centers of faces (of a component of more than 512 faces, of 512 spread over it).
std::vector<PieceContact> component_contacts(const TriangleMesh& mesh, const Topology& topology);

}  // namespace exemplar
