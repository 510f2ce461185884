#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/curvature/tangent_tensors.h"
#include "host/mesh/mesh.h"
#include "host/mesh/vertex_neighbors.h"

namespace exemplar {

/// Robust estimators, which limit the influence of outliers on least-squares fits (thesis Sec. 2.2.1, Eq. 2.7 and
/// 2.8).
enum class RobustEstimator { none, cauchy, geman_mcclure };

/// Fits tensors in vertex frames by M-estimation (after Kalogerakis et al. 2007). The tensor of a vertex is fitted
/// to the changes along all edges between the vertices of its first two rings, by iteratively reweighted least
/// squares, starting from plain least squares. The scale of the residuals is their median absolute deviation.
class RobustFits {
  public:
    explicit RobustFits(const VertexNeighbors& neighbors);

    /// Fits second fundamental forms to the change of the normals. A vertex whose edges do not span its tangent
    /// plane keeps its form.
    void fit(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames, RobustEstimator estimator,
             std::vector<Form>& forms) const;
    /// Fits the derivatives to the change of the forms. A vertex without a fit keeps its derivative.
    void fit(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames, RobustEstimator estimator,
             const std::vector<Form>& forms, std::vector<FormDerivative>& derivatives) const;

  private:
    /// Compressed rows: per vertex, itself and the vertices of its two rings; and the edges between these, as
    /// indices into that row.
    std::vector<std::size_t> begin_, edge_begin_;
    std::vector<std::uint32_t> vertex_;
    std::vector<std::array<std::uint32_t, 2>> edge_;

    template <std::size_t N, typename ValueAt, typename Result>
    void fit_all(std::span<const Vec3> vertices, const std::vector<TangentFrame>& frames, RobustEstimator estimator,
                 ValueAt&& value_at, std::vector<Result>& results) const;
};

}  // namespace exemplar
