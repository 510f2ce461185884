#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "host/labeling/features/context.h"
#include "host/learn/feature_matrix.h"
#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// So many samples stand for any surface; more would only cost memory.
constexpr std::size_t k_most_samples = 1'000'000;

struct FeatureOptions {
    /// Faces that stand for the surface in distance statistics, shape contexts, spin images and contextual features;
    /// all faces if the mesh has fewer. Sums converge as it grows.
    std::size_t samples = 1000;
    /// Adds the face centers' coordinates (App. A.1h), for data sets whose shapes share an orientation.
    bool orientation = false;
};

/// For each interior edge the interior edges near it, itself included (at distance 0), by rising geodesic distance
/// between midpoints, for the pairwise contextual features (A.2e). Range b of B = k_bins begins at (10^(b / B) - 1) / 9
/// of 5% of the median geodesic distance.
struct EdgeNeighborhood {
    static constexpr std::size_t k_bins = 5;  ///< logarithmic distance ranges up to 5% of the median geodesic distance
    std::vector<std::uint32_t> begin;         ///< E + 1 offsets
    std::vector<std::uint32_t> edge;          ///< neighbor, as an index into MeshFeatures::edges
    std::vector<std::uint8_t> bin;            ///< its distance range
};

/// Everything labeling needs to know of a mesh: computed once, cached on disk, then used by training and inference.
struct MeshFeatures {
    FeatureMatrix unary;     ///< per face (App. A.1a-h): 678 features, 681 with orientation
    FeatureMatrix pairwise;  ///< per interior edge (App. A.2a-d): 186 features
    ContextGeometry context;
    EdgeNeighborhood edge_context;
    std::vector<float> face_area;                     ///< F, in units of the median face area (Eq. 3.1)
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< E interior edges: the two faces
    std::vector<float> edge_length;                   ///< E, in units of the median edge length (Eq. 3.1)
    std::vector<float> dihedral;  ///< E, min(omega / pi, 1), omega the exterior dihedral angle (Eq. 3.4)
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time per family
};

/// Computes all features of a mesh, on all cores; the result does not depend on their number. Lengths are in units of
/// the 30th percentile of all geodesic distances, so values do not change when the mesh is moved, turned or scaled; a
/// mesh that is inside out, closed or with small holes, is turned outward. Sums over all faces are taken over
/// options.samples cells of the surface, and over all faces where few samples are near. feature_families.h documents
/// each family. Errors: UsageError if options.samples is out of range, Interrupted at Ctrl-C. Unusable meshes (empty or
/// non-finite) throw MeshError. Any other defect degrades gracefully: distances stay inside components, boundary edges
/// are left out, degenerate faces take their neighbors' geometry; every value is finite.
MeshFeatures compute_features(const TriangleMesh& mesh, const FeatureOptions& options = {});

/// Identifies the meaning of the values; changes whenever they change. Part of model files and cache keys.
constexpr int k_feature_version = 6;

}  // namespace exemplar
