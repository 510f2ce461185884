#pragma once

#include <cstddef>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/predictor.h"

namespace exemplar {

/// Computes the components z of curvature from the inputs x of a pose on the device, as
/// ComponentRegression::evaluate does, but with another order of summation.
class GpuComponentPredictor {
  public:
    /// Throws ModelError if the regression is inconsistent, DeviceLimitError if it exceeds the device's texel limit.
    GpuComponentPredictor(Device& device, const ComponentRegression& regression);

    /// Records two dispatches. `pose` has the inputs from float `first_input` on, a multiple of four, followed by a
    /// one and zeros up to the next multiple of four.
    void record(Stream& stream, const Buffer& pose, std::size_t first_input);
    /// A float per component.
    const Buffer& components() const { return components_; }
    /// Returns the number of floats of the inputs, the one and the zeros.
    std::size_t padded_inputs() const { return 4 * input_texels_; }

  private:
    std::size_t input_texels_, feature_count_ = 0, component_count_, component_threads_;
    Kernel feature_kernel_, component_kernel_;
    Buffer feature_table_, weights_, features_, component_table_, coefficients_, components_;
};

}  // namespace exemplar
