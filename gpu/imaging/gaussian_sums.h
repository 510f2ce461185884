#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/gaussian.h"

namespace exemplar {

/// Pixels per invocation.
inline constexpr std::array<std::uint32_t, 4> k_outputs_per_invocation{2, 4, 8, 16};
inline constexpr TunableParameter k_sum_outputs{"imaging/weighted_sums.comp", "outputs", k_outputs_per_invocation};
inline constexpr TunableParameter k_mask_outputs{"imaging/mask_sums.comp", "outputs", k_outputs_per_invocation};

/// A Gaussian with its weights on the device.
struct GpuGaussian {
    GaussianKernel kernel;
    Buffer weights;

    /// Throws UsageError as gaussian_kernel.
    GpuGaussian(Device& device, float sigma);
};

/// Gaussian-weighted sums along one axis of images of four lanes, the vec4s of planes: the steps of separable filters.
class GaussianSums {
  public:
    enum class Axis { x, y };
    struct Size {
        std::uint32_t width, height;
    };

    explicit GaussianSums(Device& device);

    /// Records out[k](x, y) = sum of w_o (o / sigma)^k in(x + o, y), or in(x, y + o), for as many k as there are planes
    /// in `out`, 1 to 4. What is outside of the image is zero.
    void record(Stream& stream, const GpuGaussian& gaussian, Axis axis, Size size, const Buffer& in,
                std::span<const Buffer* const> out);
    /// The same along x of one float per pixel: lane k of `out` has the power k.
    void record_mask(Stream& stream, const GpuGaussian& gaussian, Size size, const Buffer& in, const Buffer& out);

  private:
    std::uint32_t outputs_, mask_outputs_;  // pixels per invocation
    std::array<Kernel, 4> by_count_;        // of planes, from 1 on
    Kernel mask_;
};

}  // namespace exemplar
