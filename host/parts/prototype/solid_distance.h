#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/queries/point_tree.h"

namespace exemplar {

/// Distances to some faces of a mesh. Exact for the triangles of the four nearest of samples that are spread over the
/// faces at most `spacing` apart. Queries are thread-safe.
class SurfaceDistance {
  public:
    /// `faces` must not be empty. `mesh` must outlive the object.
    SurfaceDistance(const TriangleMesh& mesh, const std::vector<std::uint32_t>& faces, float spacing);

    /// Returns the distance of a point in mesh units.
    float operator()(const Vec3& point) const;

  private:
    const TriangleMesh* mesh_;
    std::vector<std::uint32_t> face_of_sample_;
    std::unique_ptr<PointTree> tree_;
};

/// Returns for each node of a grid whether it is inside a closed mesh: the faces that enter minus those that leave
/// along the grid's lines, by the majority of the three axes, as a line that hits an edge may miscount. `size`,
/// `origin` and `cell` as in ValueGrid; by increasing z, y, x.
std::vector<bool> nodes_inside(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& size, const Vec3& origin,
                               float cell);

}  // namespace exemplar
