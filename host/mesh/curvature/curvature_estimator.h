#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/mesh.h"
#include "host/mesh/curvature/robust_fit.h"

namespace exemplar {

struct CurvatureOptions {
    bool derivatives = true;
    /// Standard deviation of the Gaussian that the tensors are diffused with over the surface, in units of
    /// `smoothing_unit`; 0 = none. The derivatives are those of the smoothed curvature, then smoothed themselves.
    double smoothing = 0;
    /// Mesh units; 0 = the median edge length of the vertices at hand. Give that of the rest pose to keep the kernel of
    /// a moving mesh from breathing.
    double smoothing_unit = 0;
    /// Other than `none`: fits by iteratively reweighted least squares to the edges of two rings around each vertex
    /// (after Kalogerakis et al. 2007) in place of the faces of one.
    RobustEstimator robust = RobustEstimator::none;
};

/// Estimates curvature as estimate_curvature does, again and again for a mesh that deforms: the faces stay, the
/// vertices move. Incidence and buffers are kept between calls. Not thread-safe; runs on all cores itself.
class CurvatureEstimator {
  public:
    /// Throws MeshError if a face names a vertex that is not there.
    CurvatureEstimator(std::span<const Face> faces, std::size_t vertex_count);
    ~CurvatureEstimator();
    CurvatureEstimator(CurvatureEstimator&&) noexcept;
    CurvatureEstimator& operator=(CurvatureEstimator&&) noexcept;

    /// Curvature of the mesh with these vertices; valid until the next call, as normals() is. Vertices without proper
    /// faces have zeros. Throws UsageError for another number of vertices or a smoothing that is negative or not
    /// finite.
    const VertexCurvature& estimate(std::span<const Vec3> vertices, const CurvatureOptions& options = {});
    /// Vertex normals of the last call, as vertex_normals in mesh.h has them.
    const std::vector<Vec3>& normals() const;
    /// Median length of the edges at these vertices, in mesh units; zero without edges. Throws UsageError as estimate.
    double median_edge_length(std::span<const Vec3> vertices);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace exemplar
