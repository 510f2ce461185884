#pragma once

#include <cstddef>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/stream.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Reads the state of a surface from the local shape of its patches on the device, as StateReader::read_surface and
/// PoseRange::prepare do for a model whose state is_local().
class GpuLocalState {
  public:
    /// The model need not outlive this. `padded_inputs`: number of floats of inputs(); the first after the model's
    /// inputs is 1, the others are 0. Throws ModelError if the model is inconsistent, DeviceLimitError if it is too
    /// large for the device.
    GpuLocalState(Device& device, const CurvatureModel& model, std::size_t padded_inputs);

    /// Records two dispatches. vertices, normals: a vec4 (x, y, z, any) per vertex; normals are unit.
    void record(Stream& stream, const Buffer& vertices, const Buffer& normals);
    /// Inputs minus their means.
    const Buffer& inputs() const { return inputs_; }
    /// Per patch the three rows of its rotation, a vec4 (x, y, z, 0) each.
    const Buffer& rotations() const { return rotations_; }

  private:
    std::size_t patch_count_, input_count_, input_threads_;
    float unit_;
    Kernel rotation_kernel_, input_kernel_;
    Buffer corners_, table_, members_, weights_, biases_;
    Buffer rotations_, inputs_;
};

}  // namespace exemplar
