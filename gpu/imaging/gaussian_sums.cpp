#include "gpu/imaging/gaussian_sums.h"

#include <algorithm>
#include <vector>

#include "embedded/imaging_mask_sums_comp.h"
#include "embedded/imaging_weighted_sums_comp.h"
#include "gpu/runtime/kernels/threads.h"
#include "shaders/shared/image_filters.h"

namespace exemplar {
namespace {

using shared::SumParameters;
using shared::vec4;

constexpr std::size_t k_quad = 4;

std::size_t quads_of(const GaussianKernel& kernel) {
    return (kernel.weights.size() + k_quad - 1) / k_quad;
}

// Returns the weights in groups of four, the last filled up with zeros.
std::vector<float> padded_weights(const GaussianKernel& kernel) {
    std::vector<float> weights(k_quad * quads_of(kernel), 0.0f);
    std::ranges::transform(kernel.weights, weights.begin(), [](double w) { return static_cast<float>(w); });
    return weights;
}

SumParameters sum_parameters(const GaussianKernel& kernel, GaussianSums::Axis axis, GaussianSums::Size size) {
    const bool along_x = axis == GaussianSums::Axis::x;
    return {.pixels = along_x ? size.width : size.height,
            .lines = along_x ? size.height : size.width,
            .step = along_x ? 1 : size.width,
            .line_step = along_x ? size.width : 1,
            .radius = static_cast<std::uint32_t>(kernel.radius),
            .quads = static_cast<std::uint32_t>(quads_of(kernel)),
            .inverse_sigma = 1 / kernel.sigma,
            .unused = 0};
}

// Neighboring invocations have pixels that are near in memory.
Threads threads_of(const SumParameters& parameters, GaussianSums::Axis axis, std::uint32_t outputs) {
    const std::uint32_t per_line = (parameters.pixels + outputs - 1) / outputs;
    return axis == GaussianSums::Axis::x ? Threads(std::uint64_t{per_line} * parameters.lines)
                                         : Threads(parameters.lines, per_line);
}

}  // namespace

GpuGaussian::GpuGaussian(Device& device, Stream& stream, float sigma) : kernel(gaussian_kernel(sigma)) {
    weights = uploaded<float>(device, stream, padded_weights(kernel));
}

GaussianSums::GaussianSums(Device& device)
    : device_(device),
      outputs_(device.choose(k_sum_outputs)),
      mask_outputs_(device.choose(k_mask_outputs)),
      mask_(device, shaders::imaging_mask_sums_comp,
            {.push_constants = layout_of<SumParameters>(),
             .elements = {layout_of<float>(), layout_of<vec4>(), layout_of<vec4>()},
             .constants = {{1, mask_outputs_}}}) {}

const Kernel& GaussianSums::kernel_for(Axis axis, std::size_t planes) {
    const bool along_x = axis == Axis::x;
    Kernel& kernel = kernels_[along_x ? 1 : 0].at(planes - 1);
    const StructLayout four = layout_of<vec4>();
    if (!kernel)
        kernel =
            Kernel(device_, shaders::imaging_weighted_sums_comp,
                   {.push_constants = layout_of<SumParameters>(),
                    .elements = {four, four, four, four, four, four},
                    .constants = {{0, static_cast<std::uint32_t>(planes)}, {1, outputs_}, {2, along_x ? 1u : 0u}}});
    return kernel;
}

void GaussianSums::record(Stream& stream, const GpuGaussian& gaussian, Axis axis, Size size, const Buffer& in,
                          std::span<const Buffer* const> out) {
    const SumParameters parameters = sum_parameters(gaussian.kernel, axis, size);
    // Planes that a kernel does not write must be bound nevertheless.
    const auto plane = [&](std::size_t k) -> const Buffer& { return *out[std::min(k, out.size() - 1)]; };
    stream.dispatch(kernel_for(axis, out.size()), threads_of(parameters, axis, outputs_),
                    {in, gaussian.weights, plane(0), plane(1), plane(2), plane(3)}, parameters);
}

void GaussianSums::record_mask(Stream& stream, const GpuGaussian& gaussian, Size size, const Buffer& in,
                               const Buffer& out) {
    const SumParameters parameters = sum_parameters(gaussian.kernel, Axis::x, size);
    stream.dispatch(mask_, threads_of(parameters, Axis::x, mask_outputs_), {in, gaussian.weights, out}, parameters);
}

}  // namespace exemplar
