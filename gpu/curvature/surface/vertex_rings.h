#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// The faces around each vertex as kernels gather them: the ring of vertex v starts at texels[begin[v]], four entries a
/// texel, and runs over as many texels as it needs (see shared::k_ring_fan). Faces that name a vertex twice are left
/// out. A vertex without faces has one entry, itself.
struct VertexRings {
    std::vector<std::uint32_t> begin;
    std::vector<shared::uvec4> texels;
};

/// Orders the faces around each vertex in fans: around a vertex whose faces are oriented alike, a closed ring or the
/// fan of a boundary. Where surfaces meet or orientations clash there are several. Throws MeshError if a face refers to
/// a vertex that does not exist, or there are more vertices than rings can name (2^30).
VertexRings build_vertex_rings(const TriangleMesh& mesh);

}  // namespace exemplar
