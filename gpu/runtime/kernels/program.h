#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "gpu/runtime/kernels/layout.h"
#include "gpu/runtime/kernels/reflection.h"
#include "gpu/runtime/kernels/shader.h"
#include "gpu/runtime/vulkan/unique_handle.h"

namespace exemplar {

class Device;

/// The C++ side of a program's interface. It is compared with the declarations of the shaders when the program is
/// made.
struct ProgramInterface {
    /// layout_of<Parameters>(); none: the shader must not declare push constants.
    std::optional<StructLayout> push_constants{};
    /// Element layout of each buffer, in binding order. Storage buffers at the end may be left out, texel buffers
    /// not: their format follows from the size of the C++ type, 4 or 16 bytes.
    std::vector<StructLayout> elements{};
    /// Specialization constants: id and the bits of its value (std::bit_cast<uint32_t> for floats).
    std::vector<std::pair<std::uint32_t, std::uint32_t>> constants{};
};

/// Returns a number that no program had before.
std::uint64_t next_program_id();

/// The Vulkan objects behind a kernel or a drawing pipeline.
struct Program {
    std::string name;
    VkShaderStageFlags stages;
    Reflection reflection;
    UniqueSetLayout set_layout;
    UniquePipelineLayout layout;
    UniquePipeline pipeline;
    std::uint64_t id = next_program_id();
};

/// Throws ShaderError if the declarations of a shader differ from `interface`. Sets the texel formats in
/// `reflection`.
void check_interface(const Shader& shader, const ProgramInterface& interface, Reflection& reflection);

/// Creates the layouts of descriptor set and push constants from the program's name, stages and reflection.
void create_layouts(const Device& device, Program& program);

/// Specialization constants in Vulkan's form. info() points into the object.
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

/// Returns the shader with the module for the device as its only one.
Shader build_for(const Device& device, const Shader& shader);

/// Creates a shader module from Shader::words. It may be destroyed once the pipelines are made.
UniqueShaderModule make_module(const Device& device, const Shader& shader);

}  // namespace exemplar
