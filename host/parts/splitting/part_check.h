#pragma once

#include <cstddef>

#include "host/mesh/mesh.h"

namespace exemplar {

/// What tells whether a part can be printed, filled or simulated.
struct PartCheck {
    std::size_t boundary_edges = 0;   ///< with one face
    std::size_t irregular_edges = 0;  ///< with more than two faces, or two of inconsistent orientation
    std::size_t split_vertices = 0;   ///< whose faces form more than one fan
    double volume = 0;                ///< signed, about the center of the box, in cubic mesh units
    bool is_closed() const { return boundary_edges == 0; }
    bool is_manifold() const { return irregular_edges == 0 && split_vertices == 0; }
};
PartCheck check_part(const TriangleMesh& mesh);

/// Returns the signed volume between a surface and `center`, in double precision: of a closed surface its volume.
double signed_volume_about(const TriangleMesh& mesh, const Vec3d& center);

}  // namespace exemplar
