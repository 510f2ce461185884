#pragma once

#include <utility>
#include <vector>

#include "host/lines/extraction/face_neighbors.h"
#include "host/lines/extraction/lines.h"
#include "host/lines/extraction/split_surface.h"
#include "host/mesh/curvature/curvature_estimator.h"

namespace exemplar::test_support {

/// A mesh with estimated curvature and neighbors, cut open along its sharp edges if wanted.
struct MeasuredSurface {
    TriangleMesh mesh;
    std::vector<Vec3> normals;
    VertexCurvature curvature;
    std::vector<FaceNeighbors> neighbors;
    std::vector<Face> joined;

    explicit MeasuredSurface(TriangleMesh shape, bool cut = false)
        : mesh(std::move(shape)), neighbors(build_face_neighbors(mesh.faces, mesh.vertices)), joined(mesh.faces) {
        if (cut) {
            SharpEdges edges = find_sharp_edges(mesh.faces, mesh.vertices, LineThresholds{}.crease_angle);
            neighbors = std::move(edges.neighbors);
            if (edges.split) {
                mesh.vertices = edges.split->positions(mesh.vertices);
                mesh.faces = std::move(edges.split->faces);
            }
        }
        measure();
    }
    void measure() {
        CurvatureEstimator estimator(mesh.faces, mesh.vertex_count());
        curvature = estimator.estimate(mesh.vertices, {.derivatives = true, .smoothing = 1});
        normals = estimator.normals();
    }
    LineSurface surface() const { return {mesh.faces, mesh.vertices, normals, curvature, neighbors, joined}; }
};

}  // namespace exemplar::test_support
