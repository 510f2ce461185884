#pragma once

#include <array>
#include <cstdint>

namespace exemplar {

class Kernel;
struct DeviceInfo;

/// Number of invocations of a dispatch. A plain count may need more workgroups than one axis allows: they are folded
/// into y and z, and the shader gets its index from linear_thread() of shaders/lib/dispatch.glsl. Counts per axis
/// are for 2D and 3D kernels that use gl_GlobalInvocationID. Kernels must check their index, as the last workgroups
/// exceed the count.
struct Threads {
    Threads(std::uint64_t count) : x(count), foldable(true) {}  // NOLINT: a plain count reads best
    Threads(std::uint64_t width, std::uint64_t height, std::uint64_t depth = 1) : x(width), y(height), z(depth) {}
    std::uint64_t x;
    std::uint64_t y = 1;
    std::uint64_t z = 1;
    bool foldable = false;
};

/// Returns a box (x, y, z) of at least `groups` workgroups: the fewest slices (z) that `limit` allows, then the
/// fewest rows (y), then the shortest rows (x). It is within `limit` on each axis if any box is. It has fewer
/// surplus workgroups than rows.
/// \pre groups is at least 1.
std::array<std::uint64_t, 3> fold_groups(std::uint64_t groups, const std::array<std::uint32_t, 3>& limit);

/// Returns the workgroups of a dispatch with at least one thread along each axis. Throws DeviceLimitError if they
/// exceed the device's limit, or a plain count exceeds 32-bit indices; ShaderError if a plain count is given to a
/// kernel whose workgroups are not one-dimensional.
std::array<std::uint32_t, 3> workgroups(const Kernel& kernel, const Threads& threads, const DeviceInfo& info);

}  // namespace exemplar
