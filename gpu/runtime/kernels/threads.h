#pragma once

#include <array>
#include <cstdint>

namespace exemplar {

class Kernel;
struct DeviceInfo;

/// How many invocations a dispatch needs. A plain count may exceed any number of groups: groups are folded into y and
/// z, and the shader finds its item with linear_thread() of shaders/lib/dispatch.glsl. Counts per axis are for 2D and
/// 3D kernels that use gl_GlobalInvocationID. Kernels check their item's index: the last groups overshoot.
struct Threads {
    Threads(std::uint64_t count) : x(count), foldable(true) {}  // NOLINT: a plain count reads best
    Threads(std::uint64_t width, std::uint64_t height, std::uint64_t depth = 1) : x(width), y(height), z(depth) {}
    std::uint64_t x;
    std::uint64_t y = 1;
    std::uint64_t z = 1;
    bool foldable = false;
};

/// A box of at least `groups` workgroups: the fewest slices (z) that `limit` allows, of the fewest rows (y), which are
/// as short (x) as that leaves. Within `limit` per axis if any box is; less than one workgroup per row is too many.
/// \pre groups is at least 1.
std::array<std::uint64_t, 3> fold_groups(std::uint64_t groups, const std::array<std::uint32_t, 3>& limit);

/// The workgroups of a dispatch, at least one thread along each axis. Throws DeviceLimitError if they are over the
/// device's limit, or a plain count over what 32-bit indices reach; ShaderError if a plain count is given to a kernel
/// whose workgroups are not one-dimensional.
std::array<std::uint32_t, 3> workgroups(const Kernel& kernel, const Threads& threads, const DeviceInfo& info);

}  // namespace exemplar
