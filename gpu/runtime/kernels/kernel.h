#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "gpu/runtime/device/executable_statistics.h"
#include "gpu/runtime/kernels/program.h"

namespace exemplar {

class Device;

using KernelInterface = ProgramInterface;

/// A compute pipeline. Descriptor layout, reads and writes of each binding, and local size are reflected from
/// SPIR-V. Mark buffers `readonly` or `writeonly` in GLSL, as barriers are derived from it. Streams keep it alive
/// until they are done.
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

    const std::shared_ptr<const Program>& program() const { return program_; }

  private:
    std::shared_ptr<const Program> program_;
};

/// Compiles a shader with specialization constants (id and bits), and returns the driver's statistics of its code;
/// empty without DeviceOptions::statistics. Needs neither the C++ side of the shader's interface nor memory: a device
/// with DeviceOptions::compile_only is enough. Throws DeviceError if the driver cannot compile the shader.
std::vector<ExecutableStatistic> compile(Device& device, const Shader& shader,
                                         std::span<const std::pair<std::uint32_t, std::uint32_t>> constants);

}  // namespace exemplar
