#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "host/mesh/curvature/curvature.h"
#include "host/mesh/curvature/robust_fit.h"
#include "host/mesh/mesh.h"

namespace exemplar {

struct CurvatureOptions {
    bool derivatives = true;
    /// Standard deviation of the Gaussian that smooths the tensors over the surface, in units of `smoothing_unit`; 0
    /// = none. Derivatives are computed from the smoothed curvature and then smoothed themselves.
    double smoothing = 0;
    /// In mesh units; 0 = the median edge length of the given vertices. For a moving mesh, give the median edge
    /// length of the rest pose to keep the kernel's width constant.
    double smoothing_unit = 0;
    /// Other than `none`: fits, by iteratively reweighted least squares, to the edges of the two-ring of each vertex
    /// (after Kalogerakis et al. 2007) instead of the faces of its one-ring.
    RobustEstimator robust = RobustEstimator::none;
};

/// Estimates curvature as estimate_curvature does, again and again for a deforming mesh: the faces stay, the
/// vertices move. Keeps incidence and buffers between calls. Not thread-safe; each call runs on all cores.
class CurvatureEstimator {
  public:
    /// Throws MeshError if a face names a vertex that does not exist.
    CurvatureEstimator(std::span<const Face> faces, std::size_t vertex_count);
    ~CurvatureEstimator();
    CurvatureEstimator(CurvatureEstimator&&) noexcept;
    CurvatureEstimator& operator=(CurvatureEstimator&&) noexcept;

    /// Returns the curvature of the mesh with these vertices, valid until the next call (like normals()). Vertices
    /// without a proper face get zeros. Throws UsageError if the number of vertices differs, or the smoothing is
    /// negative or not finite.
    const VertexCurvature& estimate(std::span<const Vec3> vertices, const CurvatureOptions& options = {});
    /// Returns the vertex normals of the last call, weighted as vertex_normals in mesh.h weights them.
    const std::vector<Vec3>& normals() const;
    /// Returns the median edge length at these vertices, in mesh units; zero without edges. Throws UsageError if the
    /// number of vertices differs.
    double median_edge_length(std::span<const Vec3> vertices);

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace exemplar
