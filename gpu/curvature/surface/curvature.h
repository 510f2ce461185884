#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// Estimates normals, principal curvatures and directions, and their derivatives, of a deforming surface on the
/// device, as CurvatureEstimator does (Rusinkiewicz 2004, then diffusion). Attributes stay on the device, a vec4 per
/// vertex each. Differences from the reference:
/// - It works in single precision and ignores faces lower than 1e-6 of their longest edge (reference: 1e-7).
/// - The default unit of smoothing is the median edge length of the surface at rest.
/// - Diffusion includes the vertices that at rest are connected within k_smoothing_reach times the kernel's radius.
///   If a pose pulls farther vertices together, it misses the rim of the kernel.
class GpuCurvature {
  public:
    /// `surface` must live as long as this. Throws UsageError for robust fits, which only the host has, and for a
    /// smoothing that is negative, not finite, or reaches more vertices than a buffer of the device can list.
    explicit GpuCurvature(const GpuSurface& surface, const CurvatureOptions& options = {});

    /// Records the curvature of `vertices`, a vec4 per vertex: two dispatches, one more for smoothing, one more for
    /// derivatives, and another for both together; smoothing takes more where the device's limits are low. Throws
    /// UsageError if the vertices are not of the surface.
    void record(Stream& stream, const Buffer& vertices);
    /// Normals and areas, see GpuNormals.
    const Buffer& normals() const { return normals_.normals(); }
    /// Unit principal direction e1 and its curvature k1 >= k2, in 1 / mesh units.
    const Buffer& first() const { return first_; }
    /// The same for e2 and k2; e1 x e2 is the normal.
    const Buffer& second() const { return second_; }
    /// C111, C112, C122, C222 in (e1, e2), in 1 / squared mesh units; empty unless derivatives are requested.
    const Buffer& derivative() const { return derivative_; }

  private:
    struct Diffusion {
        // Consecutive vertices whose rows fit into one binding.
        struct Tile {
            shared::DiffusionParameters parameters;
            std::size_t offset, bytes;  // in `near`
        };
        Diffusion(const GpuSurface& surface, double width, std::size_t enough, bool derivatives);
        // `sixth`, `seventh`: the bindings in which the kernels differ.
        void record(Stream& stream, const Kernel& kernel, const Buffer& vertices, const Buffer& normals,
                    const Buffer& sixth, const Buffer& seventh) const;
        Buffer near_begin, near;
        std::vector<Tile> tiles;
        Buffer angular_components;  // tensors to smooth next, as irreducible components (to_angular_components in
                                    // tangent.glsl)
        Kernel forms, derivatives;
    };
    const GpuSurface& surface_;
    GpuNormals normals_;
    std::optional<Diffusion> diffusion_;
    Kernel curvature_kernel_, derivative_kernel_;
    Buffer first_, second_, derivative_;
};

/// Radius at rest within which vertices are included in diffusion, relative to the kernel's radius. Values above 1
/// serve compressed poses, at half again as much work for 1.25. For a wavy sheet compressed to half its width,
/// curvature differs from the reference by a twentieth.
constexpr double k_smoothing_reach = 1.25;

}  // namespace exemplar
