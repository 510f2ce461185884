#pragma once

#include <cstdint>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/queries/geodesics.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// A mesh in normalized units, with the data that the feature families share. The area centroid is the origin; the
/// 30th percentile of all geodesic distances is 1 (thesis App. A.1). "All" distances are those from the samples to
/// the faces of their component, each weighted by the areas it represents, so that the unit does not depend on the
/// tessellation.
struct PreparedMesh {
    TriangleMesh mesh;  ///< triangles in the caller's order, turned outward if the mesh was inside out
    Topology topology;
    DualGraph graph;
    std::vector<float> area_share;  ///< F, sums to 1
    float total_area = 0.0F;
    std::vector<Vec3> center, normal;           ///< F each; normals are unit and smoothed over their neighbors
    std::vector<std::uint32_t> component_size;  ///< F: number of faces in the face's component
    FaceSamples samples;
    std::vector<float> distance;   ///< S x F geodesic distances from the samples; infinity in other components
    float median_distance = 1.0F;  ///< 50th percentile of all distances, positive
    float far_distance = 1.0F;     ///< 95th percentile of all distances, positive

    std::size_t face_count() const { return mesh.face_count(); }
    std::size_t sample_count() const { return samples.face.size(); }
    /// Whether every face is a sample, so that sums over samples are exact.
    bool samples_are_all_faces() const { return sample_count() == face_count(); }
};

/// Normalizes a usable mesh (see require_usable) and computes distances from at most `samples` faces.
PreparedMesh prepare_mesh(const TriangleMesh& mesh, std::size_t samples);

/// Copies the distances between the faces [begin, end) and all samples to `out`, (end - begin) x S, from the S x F
/// matrix that the searches write: per-face sums read all samples of a face.
void gather_distances(const PreparedMesh& prepared, std::size_t begin, std::size_t end, std::vector<float>& out);

/// Returns a unit vector perpendicular to the face's normal that turns with the mesh: along the face's longest edge.
Vec3 face_tangent(const PreparedMesh& prepared, std::size_t face);

}  // namespace exemplar
