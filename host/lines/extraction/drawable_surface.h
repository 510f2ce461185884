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
    double smoothing = 1;     ///< of curvature, in median edge lengths of the first measured shape
    bool derivatives = true;  ///< whether to compute derivatives of curvature, which some line types need
    float crease_angle = LineThresholds{}.crease_angle;  ///< of edges that are sharp, see mark_sharp_edges
    bool cut =
        true;  ///< whether the surface is cut open along sharp edges, so that normals are not smoothed across them
    /// Whether curvature is not smoothed across them, either: for drawings with creases. Without creases, sharp edges
    /// in the folds of a smooth surface are to be its valleys.
    bool cut_curvature = false;
};

/// A surface with measured curvature to draw lines of, for one shape after the other with the same faces.
class DrawableSurface {
  public:
    /// `first`: the shape whose sharp edges are cut open. Faces must outlive this.
    DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first, const DrawableOptions& options);
    DrawableSurface(const DrawableSurface&) = delete;
    DrawableSurface& operator=(const DrawableSurface&) = delete;

    /// Measures the surface with these vertices, which must stay valid until the next call.
    void measure(std::span<const Vec3> vertices);
    /// Returns the measured surface, cut open along sharp edges.
    LineSurface surface() const;
    /// Returns the unit of thresholds for the measured surface, see exemplar::feature_size.
    float feature_size() const;
    /// Neighbors of the faces, with sharp edges marked.
    const std::vector<FaceNeighbors>& neighbors() const { return neighbors_; }

  private:
    std::span<const Face> faces_;
    DrawableOptions options_;
    std::vector<FaceNeighbors> neighbors_;
    std::optional<SplitSurface> split_;
    std::optional<CurvatureEstimator> estimator_;
    double smoothing_unit_ = 0;  ///< median edge length of the first measured shape
    std::span<const Vec3> vertices_;
    TriangleMesh cut_;               // the surface after cutting
    std::vector<Vec3> cut_normals_;  // if curvature is not cut
    VertexCurvature cut_curvature_;
    const VertexCurvature* curvature_ = nullptr;
};

}  // namespace exemplar
