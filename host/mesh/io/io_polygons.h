#pragma once

#include <span>
#include <string>
#include <vector>

#include "host/mesh/io/io.h"

namespace exemplar::mesh_io {

/// The vertices and polygons of a file, in the file's order, on the way to a TriangleMesh.
class PolygonList {
  public:
    std::vector<Vec3> vertices;

    /// Room for `polygons` triangles; callers bound it by the size of the file.
    void reserve_polygons(std::size_t polygons);
    /// Corners must name vertices that exist when `triangulate` is called.
    void add(std::span<const std::uint32_t> corners);
    std::size_t size() const { return corner_count_.size(); }
    std::span<const std::uint32_t> corners() const { return corners_; }
    std::span<const std::uint32_t> corner_counts() const { return corner_count_; }

    /// Cuts the polygons into triangles and moves everything into a mesh. Polygons with fewer than three corners
    /// yield no triangle but keep their number as source faces; `warnings` says how many there were.
    TriangleMesh triangulate(std::vector<std::string>& warnings) &&;

  private:
    std::vector<std::uint32_t> corners_, corner_count_;
};

/// Cuts a simple polygon into corners - 2 triangles with its orientation, appended to `faces`: a fan if it is convex,
/// else by clipping ears in the plane of its area vector. Never fails: what is not simple is cut somehow.
void triangulate_polygon(std::span<const Vec3> vertices, std::span<const std::uint32_t> corners,
                         std::vector<Face>& faces);

}  // namespace exemplar::mesh_io
