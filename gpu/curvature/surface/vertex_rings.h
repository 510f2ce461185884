#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// The faces around each vertex in the layout of the kernels: the ring of vertex v starts at texels[begin[v]], four
/// entries per texel, and takes as many texels as it needs (see shared::k_ring_fan). Faces that contain a vertex
/// twice are left out. A vertex without faces has one entry, itself.
struct VertexRings {
    std::vector<std::uint32_t> begin;
    std::vector<shared::uvec4> texels;
};

/// Orders the faces around each vertex into fans: a closed ring or the fan of a boundary, or several fans where the
/// mesh is not manifold or orientations differ. Throws MeshError if a face has a vertex that does not exist, or
/// there are more vertices than rings can index (2^30).
VertexRings build_vertex_rings(const TriangleMesh& mesh);

}  // namespace exemplar
