#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/hatching/features/direction_smoothing.h"
#include "host/hatching/features/self_occlusion.h"
#include "host/learn/feature_matrix.h"
#include "host/lines/extraction/face_neighbors.h"
#include "host/mesh/curvature/curvature.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// Curvature is measured at these shares of the median geodesic distance (thesis App. B.2).
constexpr std::array<double, 3> k_hatching_scales{0.01, 0.02, 0.05};

/// Fields of tangent directions that depend on nothing but the surface (thesis App. B.3). Completed where they are not
/// defined; unit or, where nothing defines them, zero.
struct SurfaceDirections {
    std::array<std::vector<Vec3>, k_hatching_scales.size()> k_max, k_min;  ///< principal directions
    /// Directions of largest and second largest extent of patches of 5, 10 and 20% of the median distance.
    std::array<std::vector<Vec3>, 3> e_a, e_b;
    std::vector<Vec3> ridges, valleys;  ///< along those lines
};

/// Everything that hatching needs to know of a mesh whatever the view: computed once.
struct HatchingSurface {
    TriangleMesh mesh;  ///< as given, but turned outward if it was inside out
    std::vector<Vec3> normals;
    float unit = 1;          ///< median geodesic distance, mesh units: curvatures are multiplied by it
    float feature_size = 1;  ///< mesh units, see feature_size()
    std::array<VertexCurvature, k_hatching_scales.size()> curvature;  ///< with derivatives, in 1 / mesh units
    VertexCurvature line_curvature;                                   ///< smoothed as for line drawings
    std::vector<FaceNeighbors> neighbors;
    FeatureMatrix descriptors;  ///< V x 110: shape descriptors (thesis App. B.2)
    SelfOcclusion occlusion;
    SurfaceDirections directions;
    std::vector<std::uint32_t> sample_face;  ///< S faces that stand for the surface in contextual features
    std::vector<std::uint8_t> sample_bin;    ///< S x F: range of the geodesic distance (k_context_ranges: none)
    std::vector<std::uint32_t> face_sample;  ///< F: the nearest sample
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each step
};

/// Ranges of geodesic distance of contextual features, logarithmic up to the largest distance (thesis Eq. 4.15).
constexpr std::uint8_t k_context_ranges = 4;

/// The names of the columns of HatchingSurface::descriptors.
std::vector<std::string> descriptor_names();

/// Measures a mesh, on all cores; the result does not depend on their number. Throws MeshError for unusable meshes,
/// Interrupted at Ctrl-C.
HatchingSurface measure_surface(const TriangleMesh& mesh);

/// Identifies the meaning of what measure_surface returns; changes whenever a value does. Part of cache entries.
constexpr int k_surface_version = 1;

/// Moves a measured surface to where its vertices are now. Normals, curvature, the fields that follow from it and
/// self-occlusion are measured anew. What takes long and says which part of an object one is on stays as it was:
/// descriptors, geodesic distances, units; axes of patches turn with the faces around. Throws UsageError unless there
/// is a position for each vertex, and MeshError if one is not finite.
void move_surface(HatchingSurface& surface, std::span<const Vec3> vertices);

}  // namespace exemplar
