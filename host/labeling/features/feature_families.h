#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/labeling/features/features.h"
#include "host/learn/feature_matrix.h"
#include "host/shape/neighborhoods.h"
#include "host/shape/prepared_mesh.h"
#include "host/shape/shape_families.h"

/// The feature families of thesis App. A that only labeling uses, one source file each (features_NAME.cpp); see also
/// shape_families.h. All read a PreparedMesh, compute a value for every face (or edge) and do not depend on the number
/// of threads.
namespace exemplar {

constexpr std::size_t k_min_patch_faces = 8;  ///< minimum faces of a curvature patch: 7 unknowns, 3 equations per face

/// Surface curvature (A.1a), 36 columns: nine functions of the principal curvatures of cubic patches at geodesic radii
/// of 1, 2, 5 and 10% of the median distance. Curvatures are clipped at 2 / (the smallest radius). The same patches at
/// 0.5, 1, 2 and 4% also serve the pairwise family (A.2b).
class CurvatureFamily {
  public:
    static constexpr std::array<double, 4> k_radii{0.01, 0.02, 0.05, 0.1};
    static constexpr std::array<double, 4> k_pairwise_radii{0.005, 0.01, 0.02, 0.04};
    explicit CurvatureFamily(const PreparedMesh& prepared);
    float radius() const;  ///< radius of the neighborhoods that `measure` needs
    void measure(std::uint32_t face, Neighborhood neighborhood);
    FeatureMatrix take_unary() { return std::move(unary_); }
    /// Per pairwise radius: faces x 4 values k1, k2, |dk1|, |dk2|.
    using FaceValues = std::array<std::vector<std::array<float, 4>>, k_pairwise_radii.size()>;
    FaceValues take_pairwise() { return std::move(pairwise_); }

  private:
    const PreparedMesh* prepared_;
    FeatureMatrix unary_;
    FaceValues pairwise_;
};

/// Spin images (A.1g), 100 columns.
FeatureMatrix spin_features(const PreparedMesh& prepared);
/// Face centers (A.1h), normalized units from the area centroid, 3 columns.
FeatureMatrix orientation_features(const PreparedMesh& prepared);

/// Means over the region around a face (not in the thesis), 66 columns. For geodesic radii of 10, 20 and 40% of the
/// median distance: the mean, over the samples inside, of the average distance, the shape diameters, the distances
/// from the medial surface and the curvatures at 10% in `unary`, and the face's own value minus that mean.
FeatureMatrix region_features(const PreparedMesh& prepared, const FeatureMatrix& unary);

/// Computes what the contextual label features need (A.1i): geodesic distances, with ranges over [0, the largest
/// finite distance between samples and faces]; distances |x_i - x_j| along three principal axes, and differences
/// ||x_i| - |x_j|| of the distances from three symmetry planes, with ranges over [0, the largest between a sample and
/// a face]. Ranges are those of log_bin_edges.
ContextGeometry context_geometry(const PreparedMesh& prepared);

/// The interior edges of a mesh and the graph of their midpoints: two edges of a face are joined by the segment between
/// their midpoints, which lies in the face.
struct InteriorEdges {
    std::vector<std::array<std::uint32_t, 2>> face, vertex;  ///< E each
    std::vector<float> length;                               ///< E, normalized units
    std::vector<float> dihedral;                             ///< E, min(omega / pi, 1)
    DualGraph graph;                                         ///< its nodes ("faces") are interior edges
};
InteriorEdges interior_edges(const PreparedMesh& prepared);
/// Returns the maximum size of an edge's neighborhood on a mesh of `edges` interior edges, see max_neighborhood: a 64th
/// of the edges, at least 256 and at most 1,024. Those of ordinary meshes are smaller than a 90th.
constexpr std::size_t max_edge_neighborhood(std::size_t edges) {
    return std::clamp<std::size_t>(edges / 64, 256, 1024);
}
/// Dihedral angles (A.2a), 50 columns. The same searches find the edges near each edge: `near`.
FeatureMatrix dihedral_features(const PreparedMesh& prepared, const InteriorEdges& edges, EdgeNeighborhood& near);
/// Curvature and its derivatives (A.2b), 16 columns.
FeatureMatrix edge_curvature_features(const PreparedMesh& prepared, const InteriorEdges& edges,
                                      const CurvatureFamily::FaceValues& values);
/// Absolute differences of a unary family between the two faces of each edge (A.2c, d).
FeatureMatrix difference_features(const InteriorEdges& edges, const FeatureMatrix& unary);

}  // namespace exemplar
