#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/gaussian.h"

namespace exemplar {

/// Numbers of pixels per invocation; each loaded pixel is used for all of them. D6 in docs/portability.md.
inline constexpr std::array<std::uint32_t, 4> k_outputs_per_invocation{2, 4, 8, 16};
inline constexpr TunableParameter k_sum_outputs{"imaging/weighted_sums.comp", "outputs", k_outputs_per_invocation, 8,
                                                4};
inline constexpr TunableParameter k_mask_outputs{"imaging/mask_sums.comp", "outputs", k_outputs_per_invocation, 8, 8};

/// A Gaussian with its weights in a device buffer.
struct GpuGaussian {
    GaussianKernel kernel;
    Buffer weights;

    /// Records the upload of the weights. Throws UsageError as gaussian_kernel does.
    GpuGaussian(Device& device, Stream& stream, float sigma);
};

/// Computes Gaussian-weighted sums along one axis, the steps of separable filters. Images have four lanes: a vec4
/// per pixel (a plane).
class GaussianSums {
  public:
    enum class Axis { x, y };
    struct Size {
        std::uint32_t width, height;
    };

    explicit GaussianSums(Device& device);

    /// Records out[k](x, y) = sum of w_o (o / sigma)^k in(x + o, y), or in(x, y + o), for every plane k of `out`, 1
    /// to 4 of them. Pixels outside of the image are zero.
    void record(Stream& stream, const GpuGaussian& gaussian, Axis axis, Size size, const Buffer& in,
                std::span<const Buffer* const> out);
    /// Records the same along x for an image of one float per pixel; lane k of `out` has the power k.
    void record_mask(Stream& stream, const GpuGaussian& gaussian, Size size, const Buffer& in, const Buffer& out);

  private:
    const Kernel& kernel_for(Axis axis, std::size_t planes);
    Device& device_;
    std::uint32_t outputs_, mask_outputs_;          // pixels per invocation
    std::array<std::array<Kernel, 4>, 2> kernels_;  // by axis and the number of planes, starting with 1; made when used
    Kernel mask_;
};

}  // namespace exemplar
