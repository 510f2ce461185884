#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "gpu/curvature/surface/normals.h"
#include "gpu/curvature/surface/surface.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/mesh/curvature/curvature_estimator.h"
#include "shaders/shared/curvature.h"

namespace exemplar {

/// Re-estimates normals, principal curvatures and directions, and their derivatives, of a deforming surface on the
/// device, as CurvatureEstimator does (Rusinkiewicz 2004, then diffusion). All attributes stay on the device, a vec4
/// per vertex each. It differs from the reference in this:
/// - It works in single precision; faces lower than 1e-6 of their longest edge are left out, where the reference takes
///   1e-7.
/// - The median edge length that is the unit of smoothing unless another is given is that of the surface at rest.
/// - Diffusion takes in vertices that at rest are within k_smoothing_reach times the kernel's radius, over edges: of
///   vertices that a pose pulls together from beyond, it misses the kernel's rim.
class GpuCurvature {
  public:
    /// `surface` must live as long as this. Throws UsageError for robust fits, which the device does not have, for a
    /// smoothing that is negative or not finite, or one that reaches more vertices than a buffer of the device can
    /// list.
    explicit GpuCurvature(const GpuSurface& surface, const CurvatureOptions& options = {});

    /// Curvature of `vertices`, a vec4 per vertex; two dispatches, one more each for smoothing and derivatives, and one
    /// for both (in tiles where the device's limits are low). Throws UsageError if they are not of the surface.
    void record(Stream& stream, const Buffer& vertices);
    /// Normals and areas, as GpuNormals has them.
    const Buffer& normals() const { return normals_.normals(); }
    /// The unit principal direction e1 and its curvature k1 >= k2, in 1 / mesh units.
    const Buffer& first() const { return first_; }
    /// The same of the second; e1 x e2 is the normal.
    const Buffer& second() const { return second_; }
    /// C111, C112, C122, C222 in (e1, e2), in 1 / squared mesh units; without memory unless asked for.
    const Buffer& derivative() const { return derivative_; }

  private:
    struct Diffusion {
        // As many vertices as kernels can see the rows of.
        struct Tile {
            shared::DiffusionParameters parameters;
            std::size_t offset, bytes;  // in `near`
        };
        Diffusion(const GpuSurface& surface, double width, bool derivatives);
        // `sixth` and `seventh` are the bindings in which the kernels differ.
        void record(Stream& stream, const Kernel& kernel, const Buffer& vertices, const Buffer& normals,
                    const Buffer& sixth, const Buffer& seventh) const;
        Buffer near_begin, near;
        std::vector<Tile> tiles;
        Buffer spins;  // of what is to be smoothed next
        Kernel forms, derivatives;
    };
    const GpuSurface& surface_;
    GpuNormals normals_;
    std::optional<Diffusion> diffusion_;
    Kernel curvature_kernel_, derivative_kernel_;
    Buffer first_, second_, derivative_;
};

/// How much farther than the kernel of diffusion reaches vertices are taken in at rest: what compressed poses need, for
/// half again as much work. Pressed to half its width as a whole, a wavy sheet differs by a twentieth.
constexpr double k_smoothing_reach = 1.25;

}  // namespace exemplar
