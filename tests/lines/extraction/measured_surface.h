#pragma once

#include <utility>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/lines/extraction/lines.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar::test_support {

/// A mesh with estimated curvature and neighbors.
struct MeasuredSurface {
    TriangleMesh mesh;
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    std::vector<FaceNeighbors> neighbors;

    explicit MeasuredSurface(TriangleMesh shape) : mesh(std::move(shape)) {
        measure();
        neighbors = build_face_neighbors(mesh.faces, mesh.vertex_count());
    }
    void measure() {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        curvature = estimator.estimate(mesh.vertices, {.derivatives = true, .smoothing = 1});
        normals = estimator.normals();
    }
    LineSurface surface() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors}; }
};

}  // namespace exemplar::test_support
