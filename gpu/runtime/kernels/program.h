#pragma once

#include <volk.h>

#include <optional>
#include <string>
#include <vector>

#include "gpu/runtime/kernels/layout.h"
#include "gpu/runtime/kernels/reflection.h"
#include "gpu/runtime/kernels/shader.h"
#include "gpu/runtime/device/unique_handle.h"

namespace exemplar {

class Device;

/// What C++ hands to a program on the device: compared with what its shaders declare when it is made.
struct ProgramInterface {
    /// layout_of<Parameters>(); without it the shader may have no push constants.
    std::optional<StructLayout> push_constants{};
    /// Per buffer in binding order, the layout of an element of its array; may stop early, but not before texels: the
    /// size of their C++ type, 4 or 16 bytes, is their format.
    std::vector<StructLayout> elements{};
    /// Specialization constants: id and the bits of its value (std::bit_cast<uint32_t> for floats).
    std::vector<std::pair<std::uint32_t, std::uint32_t>> constants{};
};

/// The Vulkan objects behind a kernel or a drawing pipeline.
struct Program {
    std::string name;
    VkShaderStageFlags stages;
    Reflection reflection;
    UniqueSetLayout set_layout;
    UniquePipelineLayout layout;
    UniquePipeline pipeline;
};

/// Throws ShaderError if what one of a program's shaders declares and `interface` disagree; sets the formats of texels.
void check_interface(const Shader& shader, const ProgramInterface& interface, Reflection& reflection);

/// Makes the layouts of descriptor set and push constants from name, stages and reflection.
void create_layouts(const Device& device, Program& program);

/// Specialization constants as pipelines take them; points into itself.
class Specialization {
  public:
    explicit Specialization(const ProgramInterface& interface);
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;
    const VkSpecializationInfo& info() const { return info_; }

  private:
    std::vector<VkSpecializationMapEntry> entries_;
    std::vector<std::uint32_t> values_;
    VkSpecializationInfo info_;
};

/// A shader as pipelines take it; it may end when they are made.
UniqueShaderModule make_module(const Device& device, const Shader& shader);

}  // namespace exemplar
