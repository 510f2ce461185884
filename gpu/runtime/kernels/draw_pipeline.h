#pragma once

#include <volk.h>

#include <memory>
#include <string_view>

#include "gpu/runtime/kernels/program.h"

namespace exemplar {

/// What a drawing pipeline does to the images of a pass.
struct DrawState {
    VkFormat color = VK_FORMAT_UNDEFINED;
    VkFormat depth = VK_FORMAT_UNDEFINED;  ///< none: drawn over all that is there
    bool writes_depth = true;
    VkCompareOp depth_test = VK_COMPARE_OP_LESS;
    bool blends = false;  ///< color over color, by an alpha that the shader has multiplied it with
    /// Added to depths: in units of the least difference, and of the slope.
    float depth_bias = 0, slope_bias = 0;
};

/// A vertex and a fragment shader that draw triangles into color and, perhaps, depth. Both read storage and texel
/// buffers only, vertices too, which the vertex shader finds by their index; they share bindings and push constants.
/// Nothing is culled: surfaces of the wild are open, or wound the wrong way. Streams keep it alive until they are done.
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
