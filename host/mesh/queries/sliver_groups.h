#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Long thin faces that lie together and point about the same way.
struct SliverGroup {
    Eigen::Matrix3f rotation;          ///< into a frame whose x axis is along the faces
    std::vector<std::uint32_t> faces;  ///< in increasing order
};

/// Groups the faces that are slivers across the coordinate axes, so that their bounding boxes are much larger than they
/// are: in a fan of n of them every box overlaps most others, and a ray meets all. In the frame of a group they do not
/// overlap much. Groups have up to max(64, square root of their number) faces, or more where all are parallel. Returns
/// nothing if there are fewer than `min_slivers`, as in ordinary meshes. O(n log n).
std::vector<SliverGroup> group_slivers(const TriangleMesh& mesh, std::size_t min_slivers = 1024);

}  // namespace exemplar
