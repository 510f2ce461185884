#pragma once

#include <cstddef>

#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/predictor.h"

namespace exemplar {

/// From the inputs x of a pose to the components z of curvature on the device, as ComponentRegression::evaluate. Sums
/// are taken in another order.
class GpuComponentPredictor {
  public:
    /// Throws ModelError if the regression contradicts itself, DeviceLimitError if kernels cannot see all of it.
    GpuComponentPredictor(Device& device, const ComponentRegression& regression);

    /// Two dispatches. `pose` has the inputs from float `first_input` on, a multiple of four, and behind them a one and
    /// zeros to the next multiple of four.
    void record(Stream& stream, const Buffer& pose, std::size_t first_input);
    /// A float per component.
    const Buffer& components() const { return components_; }
    /// Floats that the inputs, the one and the zeros take.
    std::size_t padded_inputs() const { return 4 * input_texels_; }

  private:
    std::size_t input_texels_, feature_count_ = 0, component_count_;
    Kernel feature_kernel_, component_kernel_;
    Buffer feature_table_, weights_, features_, component_table_, coefficients_, components_;
};

}  // namespace exemplar
