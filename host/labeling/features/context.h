#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/learn/feature_matrix.h"

namespace exemplar {

constexpr std::size_t k_context_bins = 5;  ///< distance ranges B of Eq. A.1
constexpr std::size_t k_context_axes = 6;  ///< 3 principal axes, 3 symmetry axes
constexpr std::uint8_t k_no_bin = 255;
constexpr std::size_t k_context_measures = 7;  ///< geodesic distance and the axes

/// Geometry of one mesh for the contextual label features; it is fixed while the cascade runs.
struct ContextGeometry {
    std::size_t faces = 0;
    std::vector<std::uint32_t> sample_face;  ///< S faces that represent the surface
    std::vector<float> sample_area;          ///< S area shares, summing to 1 (a_j of Eq. A.1)
    /// S x faces: the range of the geodesic distance from each sample to each face, 0 .. k_context_bins - 1, or
    /// k_no_bin where there is no path. Only the range matters, so a byte replaces the distance: a quarter of the
    /// memory traffic.
    std::vector<std::uint8_t> geodesic_bin;
    /// k_context_axes x faces. Principal axes: the centered position x, whose sign is arbitrary as only distances
    /// count. Symmetry planes: the distance |x|, as both sides are alike.
    std::vector<float> axis_position;
    /// k_context_axes x (k_context_bins - 1): inner range edges of the differences of positions, rising.
    /// Range = number of edges <= distance.
    std::array<std::array<float, k_context_bins - 1>, k_context_axes> axis_edges{};
};

/// A mesh and the output of its histograms; see ContextHistograms.
struct ContextMesh {
    const ContextGeometry* geometry;
    std::span<const float> probabilities;
    std::span<float> out;
};

/// Contextual label histograms (Eq. A.1): for each face i, class l, measure t and bin b, the sum of sample_area[j] *
/// P(l | j) over the samples j with dist_t(i, j) in bin b. Column order: (measure * bins + bin) * classes + class.
/// `probabilities` is faces x classes, item-major; `out` is (k_context_measures * k_context_bins * classes) x faces,
/// feature-major. The CPU implementation is the reference; gpu/labeling implements it in a shader. Throws UsageError
/// if the sizes of a geometry and its spans contradict each other.
class ContextHistograms {
  public:
    virtual ~ContextHistograms() = default;
    void accumulate(const ContextGeometry& geometry, std::span<const float> probabilities, std::size_t classes,
                    std::span<float> out) {
        const ContextMesh one{&geometry, probabilities, out};
        accumulate_all(std::span(&one, 1), classes);
    }
    /// Computes the histograms of several meshes, faster than one by one. Each mesh gets the result that it would get
    /// alone, bit for bit on one device. Computes nothing if the sizes of one mesh are wrong.
    virtual void accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) = 0;
};

/// Throws UsageError if the sizes inside a geometry contradict each other, or a sample is no face of it.
void check_geometry(const ContextGeometry& geometry);
/// Throws UsageError if the sizes inside a mesh's geometry contradict each other, or its spans do not fit it.
void check_context(const ContextMesh& mesh, std::size_t classes);

class CpuContextHistograms final : public ContextHistograms {
  public:
    void accumulate_all(std::span<const ContextMesh> meshes, std::size_t classes) override;
};

}  // namespace exemplar
