#pragma once

#include <volk.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gpu/runtime/layout.h"
#include "gpu/runtime/reflection.h"
#include "gpu/runtime/shader.h"
#include "gpu/runtime/unique_handle.h"

namespace exemplar {

class Device;

/// What C++ hands to a kernel: compared with what the shader declares when the kernel is made.
struct KernelInterface {
    /// layout_of<Parameters>(); without it the shader may have no push constants.
    std::optional<StructLayout> push_constants{};
    /// Per buffer in binding order, the layout of an element of its array; may stop early, but not before texels: the
    /// size of their C++ type, 4 or 16 bytes, is their format.
    std::vector<StructLayout> elements{};
    /// Specialization constants: id and the bits of its value (std::bit_cast<uint32_t> for floats).
    std::vector<std::pair<std::uint32_t, std::uint32_t>> constants{};
};

/// A compute pipeline. The descriptor layout, which bindings are read or written and the local size come from the
/// SPIR-V itself: mark buffers `readonly` or `writeonly` in GLSL, and barriers follow. Streams keep it alive until they
/// are done.
class Kernel {
  public:
    Kernel() = default;
    /// Throws ShaderError if the shader and `interface` disagree, DeviceLimitError if it needs more than the device
    /// allows.
    Kernel(Device& device, const Shader& shader, const KernelInterface& interface = {});
    Kernel(Kernel&&) = default;
    Kernel& operator=(Kernel&&) = default;
    Kernel(const Kernel&) = delete;
    Kernel& operator=(const Kernel&) = delete;

    explicit operator bool() const { return program_ != nullptr; }
    std::string_view name() const { return program_->name; }
    const Reflection& reflection() const { return program_->reflection; }
    /// Invocations per workgroup and axis, after specialization.
    std::array<std::uint32_t, 3> local_size() const { return program_->reflection.local_size; }

    /// The Vulkan objects behind a kernel.
    struct Program {
        std::string name;
        Reflection reflection;
        UniqueSetLayout set_layout;
        UniquePipelineLayout layout;
        UniquePipeline pipeline;
    };
    const std::shared_ptr<const Program>& program() const { return program_; }

  private:
    std::shared_ptr<const Program> program_;
};

/// A shader as pipelines take it; it may end when they are made.
UniqueShaderModule make_module(const Device& device, const Shader& shader);

}  // namespace exemplar
