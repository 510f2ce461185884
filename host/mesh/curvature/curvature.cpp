#include "host/mesh/curvature/curvature.h"

#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar {

VertexCurvature estimate_curvature(const TriangleMesh& mesh, bool with_derivatives) {
    CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
    CurvatureOptions options;
    options.derivatives = with_derivatives;
    return estimator.estimate(mesh.vertices, options);
}

}  // namespace exemplar
