#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/mesh/io/io.h"

namespace exemplar::mesh_io {

/// Collects the vertices and polygons of a file, in the file's order, and turns them into a TriangleMesh.
class PolygonList {
  public:
    std::vector<Vec3> vertices;    ///< of files that hold floats
    std::vector<Vec3d> positions;  ///< of all other files, in place of `vertices`

    /// Reserves memory for `polygons` triangles; callers bound it by the size of the file.
    void reserve_polygons(std::size_t polygons);
    /// Corners must name vertices that exist when `triangulate` is called.
    void add(std::span<const std::uint32_t> corners);
    std::size_t size() const { return corner_count_.size(); }
    std::span<const std::uint32_t> corners() const { return corners_; }
    std::span<const std::uint32_t> corner_counts() const { return corner_count_; }

    /// Cuts the polygons into triangles and moves everything into a mesh, whose origin is that of its positions.
    /// Polygons with fewer than three corners give no triangle but keep their source face number; a line in `warnings`
    /// counts them.
    TriangleMesh triangulate(std::vector<std::string>& warnings) &&;
    /// Triangulates into the mesh of a file, which keeps the polygons if not all are triangles.
    void triangulate_into(MeshFile& file) &&;

  private:
    std::vector<std::uint32_t> corners_of_triangles() const;

    std::vector<std::uint32_t> corners_, corner_count_;
};

/// Cuts a simple polygon into corners - 2 triangles of its orientation and appends them to `faces`: as a fan if it
/// is convex or very long, else by clipping ears in the plane of its area vector. Never fails: a polygon that is not
/// simple is cut somehow.
void triangulate_polygon(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners,
                         std::vector<Face>& faces);

}  // namespace exemplar::mesh_io
