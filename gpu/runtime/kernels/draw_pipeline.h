#pragma once

#include <vulkan/vulkan_core.h>

#include <memory>
#include <string_view>

#include "gpu/runtime/kernels/program.h"

namespace exemplar {

/// Fixed state of a drawing pipeline.
struct DrawState {
    VkFormat color = VK_FORMAT_UNDEFINED;
    VkFormat depth = VK_FORMAT_UNDEFINED;  ///< undefined: no depth, draws over everything
    bool writes_depth = true;
    VkCompareOp depth_test = VK_COMPARE_OP_LESS;
    bool blends = false;  ///< draws premultiplied colors over those of the image
    /// Added to depths: a constant in units of the smallest depth difference, and a factor of the slope.
    float depth_bias = 0, slope_bias = 0;
};

/// A pipeline that draws triangles into a color image and, optionally, a depth image. Both shaders share bindings
/// and push constants and read only storage and texel buffers; the vertex shader fetches vertices by index. No faces
/// are culled, as real meshes may be open or wrongly oriented. Streams keep it alive until they are done.
class DrawPipeline {
  public:
    DrawPipeline() = default;
    /// Throws DeviceError if the device's queue cannot draw, ShaderError if shaders and `interface` disagree.
    DrawPipeline(Device& device, const Shader& vertex, const Shader& fragment, const ProgramInterface& interface,
                 const DrawState& state);

    explicit operator bool() const { return program_ != nullptr; }
    std::string_view name() const { return program_->name; }
    const std::shared_ptr<const Program>& program() const { return program_; }

  private:
    std::shared_ptr<const Program> program_;
};

}  // namespace exemplar
