#include "gpu/runtime/kernels/threads.h"

#include <fmt/format.h>

#include <cstddef>
#include <limits>

#include "gpu/runtime/device/device_info.h"
#include "gpu/runtime/kernels/kernel.h"
#include "gpu/runtime/vulkan/errors.h"

namespace exemplar {
namespace {

constexpr std::uint64_t k_max_threads = std::numeric_limits<std::uint32_t>::max();

std::uint64_t divide_up(std::uint64_t count, std::uint64_t size) {
    return count / size + (count % size != 0);
}

[[noreturn]] void throw_too_many(const Kernel& kernel, const Threads& threads) {
    throw DeviceLimitError(
        fmt::format("kernel {} over {} threads: its indices have 32 bits, which is up to {} threads; "
                    "tile the work",
                    kernel.name(), threads.x, k_max_threads),
        threads.x, k_max_threads);
}

void check_foldable(const Kernel& kernel, const Threads& threads) {
    if (kernel.local_size()[1] != 1 || kernel.local_size()[2] != 1)
        throw ShaderError(fmt::format("kernel {} has workgroups of {} x {} x {}: give its threads per axis",
                                      kernel.name(), kernel.local_size()[0], kernel.local_size()[1],
                                      kernel.local_size()[2]));
    if (threads.x > k_max_threads) throw_too_many(kernel, threads);
}

}  // namespace

std::array<std::uint64_t, 3> fold_groups(std::uint64_t groups, const std::array<std::uint32_t, 3>& limit) {
    const std::uint64_t rows = divide_up(groups, limit[0]);
    const std::uint64_t slices = divide_up(rows, limit[1]);
    const std::uint64_t rows_per_slice = divide_up(rows, slices);
    return {divide_up(groups, slices * rows_per_slice), rows_per_slice, slices};
}

std::array<std::uint32_t, 3> workgroups(const Kernel& kernel, const Threads& threads, const DeviceInfo& info) {
    if (threads.foldable) check_foldable(kernel, threads);
    const std::array<std::uint32_t, 3> local = kernel.local_size();
    std::array<std::uint64_t, 3> groups{divide_up(threads.x, local[0]), divide_up(threads.y, local[1]),
                                        divide_up(threads.z, local[2])};
    if (threads.foldable) groups = fold_groups(groups[0], info.max_groups);
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (groups[axis] > info.max_groups[axis])
            throw DeviceLimitError(
                fmt::format("kernel {} needs {} workgroups along axis {}, over the limit of {} of device '{}'",
                            kernel.name(), groups[axis], axis, info.max_groups[axis], info.name),
                groups[axis], info.max_groups[axis]);
    // Surplus threads have indices too.
    if (threads.foldable && groups[0] * groups[1] * groups[2] * local[0] > k_max_threads)
        throw_too_many(kernel, threads);
    return {static_cast<std::uint32_t>(groups[0]), static_cast<std::uint32_t>(groups[1]),
            static_cast<std::uint32_t>(groups[2])};
}

}  // namespace exemplar
