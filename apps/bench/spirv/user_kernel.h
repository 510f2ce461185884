#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/bench/spirv/inputs.h"
#include "apps/bench/spirv/module_check.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/kernels/scalars.h"
#include "gpu/runtime/record/buffer.h"
#include "gpu/runtime/record/profiler.h"
#include "gpu/runtime/record/stream.h"

namespace exemplar {

/// Contents of bindings, by number.
using Contents = std::map<std::uint32_t, Bytes>;

/// How a user's shader is started.
struct UserDispatch {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> constants;  ///< specialization: id and bits
    std::array<std::uint64_t, 3> size{1, 1, 1};                      ///< workgroups or threads per axis
    bool size_is_groups = false;
    std::map<std::uint32_t, std::uint32_t> texel_bytes;  ///< 4 or 16; 16 where none are given
    bool restores = true;  ///< whether buffers that the kernel reads and writes are restored before each dispatch
};

/// The interface of a user's shader.
struct UserInterface {
    explicit UserInterface(const UserShader& shader, const UserDispatch& dispatch);

    Reflection reflection;  ///< with the local size after specialization, and the sizes of texels
    ShaderScalars scalars;

    /// Returns the numbers of a storage buffer; null for texels.
    const BlockScalars* block(std::uint32_t binding) const;
    const ReflectedBinding* binding(std::uint32_t number) const;
    std::array<std::uint64_t, 3> threads(const UserDispatch& dispatch) const;
};

/// Returns the contents of all bindings: what is given, else the defaults. Throws UsageError if a binding is given that
/// none of the shaders has, or whose size does not fit.
Contents contents_of_bindings(const std::vector<const UserInterface*>& interfaces,
                              const std::vector<BindingSource>& sources, std::uint64_t threads,
                              const DeviceInfo& device);

/// A user's shader with its buffers on a device.
class UserKernel {
  public:
    /// Throws ShaderError or DeviceLimitError if the device cannot run it so.
    UserKernel(Device& device, const UserShader& shader, const UserInterface& interface, const UserDispatch& dispatch,
               Bytes push, const Contents& contents);

    /// Dispatches `count` times in one submission, and waits. Each dispatch reports to profiler().
    void run(std::size_t count);
    Profiler& profiler() { return profiler_; }
    /// Gives all buffers their first contents.
    void restore();
    /// Returns the contents of a binding.
    Bytes contents(std::uint32_t binding) const;

  private:
    struct Slot {
        std::uint32_t binding;
        Buffer buffer;
        Buffer original;  // without memory if the buffer is not restored
        const Bytes* contents;
    };
    Kernel kernel_;
    Threads threads_;
    Bytes push_;
    std::vector<Slot> slots_;
    std::vector<BufferRange> ranges_;
    Profiler profiler_;
    Stream stream_;
};

}  // namespace exemplar
