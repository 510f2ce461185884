#pragma once

#include <optional>
#include <span>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "host/lines/extraction/split_surface.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {

/// How a surface is measured for drawing.
struct DrawableOptions {
    /// How curvature is measured. The unit of smoothing, if it is 0, is the median edge length of the first measured
    /// shape.
    CurvatureOptions curvature{.smoothing = 1};
    float crease_angle = LineThresholds{}.crease_angle;  ///< of edges that are sharp, see mark_sharp_edges
    /// Whether curvature is measured on the parts that the surface is cut into, and not smoothed across sharp edges:
    /// for drawings with creases. Without creases, sharp edges in the folds of a smooth surface are to be its valleys.
    bool cut_curvature = false;
};

/// A surface to draw lines of, cut open along its sharp edges, for one shape after the other with the same faces.
/// Normals are those of the parts it is cut into.
class DrawableSurface {
  public:
    /// `first`: the shape whose sharp edges are cut open. Faces must outlive this. Throws as mark_sharp_edges.
    DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first, const DrawableOptions& options = {});
    DrawableSurface(const DrawableSurface&) = delete;
    DrawableSurface& operator=(const DrawableSurface&) = delete;

    /// Measures the curvature of a shape. Its vertices must stay valid until the next call.
    void measure(std::span<const Vec3> vertices);
    /// Takes a shape with known normals and curvature, those of the surface before it is cut open. All must stay valid
    /// until the next call.
    void take(std::span<const Vec3> vertices, std::span<const Vec3> normals, const VertexCurvature& curvature);
    /// Returns the last shape, cut open along sharp edges.
    LineSurface surface() const;
    /// Returns the unit of thresholds for the last measured shape, see exemplar::feature_size.
    float feature_size() const;

  private:
    bool measures_parts() const { return options_.cut_curvature && edges_.split; }
    std::span<const Face> faces_;
    DrawableOptions options_;
    SharpEdges edges_;
    std::optional<CurvatureEstimator> estimator_;
    const VertexCurvature* measured_ = nullptr;
    // The last shape as surface() returns it.
    std::span<const Vec3> vertices_, normals_;
    const VertexCurvature* curvature_ = nullptr;
    // Data of the last shape after cutting, if the surface has sharp edges.
    TriangleMesh cut_;
    std::vector<Vec3> cut_normals_;
    VertexCurvature cut_curvature_;
};

}  // namespace exemplar
