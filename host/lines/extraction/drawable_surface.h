#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/lines/extraction/lines.h"
#include "host/lines/extraction/split_surface.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh as it is drawn: with one vertex per place, and faces that look outward.
struct DrawableMesh {
    TriangleMesh mesh;
    bool turned = false;  ///< it was inside out
};
/// Throws MeshError naming `name` if the mesh is empty or not finite.
DrawableMesh drawable_mesh(const TriangleMesh& mesh, const std::string& name);

/// How a surface is measured for drawing.
struct DrawableOptions {
    double smoothing = 1;     ///< of curvature, in median edge lengths of the first shape
    bool derivatives = true;  ///< of curvature: some type of lines needs them
    /// Radians: curvature and normals know nothing of what is across edges of a larger angle; none: they do.
    std::optional<float> split_angle;
};

/// A surface of measured curvature that lines are drawn of, for one shape after the other: the faces stay.
class DrawableSurface {
  public:
    /// `first` is the shape that is cut open along edges of the split angle. Faces must outlive this.
    DrawableSurface(std::span<const Face> faces, std::span<const Vec3> first, const DrawableOptions& options);
    DrawableSurface(const DrawableSurface&) = delete;
    DrawableSurface& operator=(const DrawableSurface&) = delete;

    /// Measures the surface with these vertices, which must stay until the next call.
    void measure(std::span<const Vec3> vertices);
    /// As it was measured, cut open along edges of the split angle.
    LineSurface surface() const;
    /// The same as it is, without normals and curvature: what creases and boundaries are of; null if it was not cut.
    const LineSurface* edges() const { return edges_ ? &*edges_ : nullptr; }
    const std::vector<FaceNeighbors>& neighbors() const { return neighbors_; }

  private:
    std::span<const Face> faces_;
    DrawableOptions options_;
    std::vector<FaceNeighbors> neighbors_;
    std::optional<SplitSurface> split_;
    std::optional<CurvatureEstimator> estimator_;
    double smoothing_unit_ = 0;  ///< the median edge length of the first shape
    std::span<const Vec3> vertices_;
    std::vector<Vec3> split_vertices_, no_normals_;
    VertexCurvature no_curvature_;
    std::optional<LineSurface> edges_;
    const VertexCurvature* curvature_ = nullptr;
};

}  // namespace exemplar
