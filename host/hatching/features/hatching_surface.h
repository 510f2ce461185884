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

/// Scales at which curvature is measured, as shares of the median geodesic distance (thesis App. B.2).
constexpr std::array<double, 3> k_hatching_scales{0.01, 0.02, 0.05};

/// Fields of tangent directions that depend only on the surface (thesis App. B.3), completed where they are
/// undefined. Vectors have unit length, or are zero where nothing defines them.
struct SurfaceDirections {
    std::array<std::vector<Vec3>, k_hatching_scales.size()> k_max, k_min;  ///< principal directions
    /// Directions of largest and second largest extent of patches of 5, 10 and 20% of the median distance.
    std::array<std::vector<Vec3>, 3> e_a, e_b;
    std::vector<Vec3> ridges, valleys;  ///< along those lines
};

/// All properties of a mesh that hatching uses and that do not depend on the view; computed once.
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
    std::vector<std::uint32_t> sample_face;  ///< S faces that sample the surface for contextual features
    std::vector<std::uint8_t> sample_bin;    ///< S x F: range of geodesic distance; k_context_ranges: unreachable
    std::vector<std::uint32_t> face_sample;  ///< F: the nearest sample
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time of each step
};

/// Number of ranges of geodesic distance in contextual features; logarithmic up to the largest distance (thesis Eq.
/// 4.15).
constexpr std::uint8_t k_context_ranges = 4;

/// Returns the names of the columns of HatchingSurface::descriptors.
std::vector<std::string> descriptor_names();

/// Measures a mesh on all cores; the result does not depend on their number. Throws MeshError for unusable meshes,
/// Interrupted at Ctrl-C.
HatchingSurface measure_surface(const TriangleMesh& mesh);

/// Version of the values that measure_surface returns; changes whenever a value does. Part of cache entries.
constexpr int k_surface_version = 1;

/// Moves the vertices of a measured surface. Normals, curvature, the direction fields that follow from it, and
/// self-occlusion are measured again. Descriptors, geodesic distances and units stay: they take long, and identify
/// parts of the object. Axes of patches rotate with the faces around them. Throws UsageError unless there is a
/// position for each vertex, and MeshError if one is not finite.
void move_surface(HatchingSurface& surface, std::span<const Vec3> vertices);

}  // namespace exemplar
