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

/// Maximum of FeatureOptions::samples; more would only cost memory.
constexpr std::size_t k_max_samples = 1'000'000;

struct FeatureOptions {
    /// Number of faces that represent the surface in distance statistics, shape contexts, spin images and contextual
    /// features; all faces if the mesh has fewer. Sums converge as it grows.
    std::size_t samples = 1000;
    /// Adds the face centers' coordinates (App. A.1h) to the faces' features. Labeling adds them itself, see
    /// set_orientation.
    bool orientation = false;
};

/// For each interior edge, the interior edges near it, itself included (at distance 0), by rising geodesic distance
/// between midpoints: all, or the nearest max_edge_neighborhood. Used by the pairwise contextual features (A.2e). Range
/// b of B = k_bins begins at (10^(b / B) - 1) / 9 of 5% of the median geodesic distance.
struct EdgeNeighborhood {
    static constexpr std::size_t k_bins = 5;  ///< logarithmic distance ranges up to 5% of the median geodesic distance
    std::vector<std::uint32_t> begin;         ///< E + 1 offsets
    std::vector<std::uint32_t> edge;          ///< neighbor, as an index into MeshFeatures::edges
    std::vector<std::uint8_t> bin;            ///< its distance range
};

/// The features of a mesh that labeling uses: computed once, cached on disk, then read by training and inference.
struct MeshFeatures {
    FeatureMatrix unary;     ///< per face (App. A.1a-h): 678 features, 681 with orientation
    FeatureMatrix pairwise;  ///< per interior edge (App. A.2a-d): 186 features
    ContextGeometry context;
    EdgeNeighborhood edge_context;
    std::vector<float> position;                      ///< 3 x F: x, y and z of the face centers (App. A.1h)
    std::vector<float> face_area;                     ///< F, in units of the median face area (Eq. 3.1)
    std::vector<std::array<std::uint32_t, 2>> edges;  ///< E interior edges: the two faces
    std::vector<float> edge_length;                   ///< E, in units of the median edge length (Eq. 3.1)
    std::vector<float> dihedral;  ///< E, min(omega / pi, 1), omega the exterior dihedral angle (Eq. 3.4)
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time per family
};

/// Returns whether a column is none of a mesh alone, but one that labeling appends: contextual ones, which depend on
/// labels, and coordinates, which depend on how the mesh lies.
bool is_appended(const std::string& name);

/// Computes all features of a mesh, on all cores; the result does not depend on their number. feature_families.h
/// documents the families. The unit of length is the 30th percentile of all geodesic distances, so values do not
/// change when the mesh is moved, rotated or scaled. Inside-out meshes, closed or with small holes, are turned
/// outward. Sums over all faces run over options.samples cells of the surface, and over all faces where few samples
/// are near. Every value is finite, also for defective meshes: distances stay inside components, boundary edges are
/// left out, degenerate faces take their neighbors' geometry.
/// Throws UsageError if options.samples is out of range, MeshError for an unusable mesh (empty or non-finite),
/// Interrupted at Ctrl-C.
MeshFeatures compute_features(const TriangleMesh& mesh, const FeatureOptions& options = {});

/// Version of the feature values, part of model files and cache keys; changes whenever the values change.
constexpr int k_feature_version = 7;

}  // namespace exemplar
