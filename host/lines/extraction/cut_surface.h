#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "host/lines/extraction/split_surface.h"

namespace exemplar {

/// Returns the curvature of the vertices of a cut surface, each that of the one it was cut from (SplitSurface::source).
VertexCurvature curvature_after_cut(const VertexCurvature& curvature, std::span<const std::uint32_t> source);

/// A surface with known curvature, cut open along its sharp edges to draw lines of it. Normals are those of its smooth
/// parts; curvature stays as it is. (DrawableSurface measures curvature, too.)
class CutSurface {
  public:
    /// All that is given must outlive this. Throws MeshError and UsageError as mark_sharp_edges.
    CutSurface(std::span<const Face> faces, std::span<const Vec3> vertices, std::span<const Vec3> normals,
               const VertexCurvature& curvature, float crease_angle = LineThresholds{}.crease_angle);

    LineSurface surface() const;

  private:
    std::span<const Face> faces_;
    std::span<const Vec3> vertices_, normals_;
    const VertexCurvature& curvature_;
    std::vector<FaceNeighbors> neighbors_;
    std::optional<SplitSurface> split_;
    TriangleMesh cut_;
    std::vector<Vec3> cut_normals_;
    VertexCurvature cut_curvature_;
};

}  // namespace exemplar
