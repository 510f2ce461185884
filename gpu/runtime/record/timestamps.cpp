#include "gpu/runtime/record/timestamps.h"

#include <array>
#include <cstddef>

#include "gpu/runtime/device/device.h"
#include "gpu/runtime/vulkan/errors.h"
#include "gpu/runtime/vulkan/functions.h"

namespace exemplar {
namespace {

constexpr std::uint32_t k_dispatches_per_pool = 512;

// Writes a timestamp. Nothing after it may begin earlier, or kernels that do not depend on each other would be charged
// for each other (and D11 in docs/portability.md).
void write(VkCommandBuffer commands, VkPipelineStageFlags2 stage, VkQueryPool pool, std::uint32_t query) {
    vkCmdWriteTimestamp2(commands, stage, pool, query);
    auto barrier = empty_structure<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    auto dependency = empty_structure<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

bool Timestamps::enabled() const {
    return profiler_ && device_.info().timestamp_period > 0.0f;
}

void Timestamps::add_pool() {
    auto info = empty_structure<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2 * k_dispatches_per_pool;
    UniqueQueryPool pool(device_.handle());
    check(vkCreateQueryPool(device_.handle(), &info, nullptr, pool.put()), "make timestamp queries");
    pools_.push_back(std::move(pool));
}

// The first timestamp waits for all earlier commands, copies too, so that a dispatch is not charged for them.
void Timestamps::start(VkCommandBuffer commands, std::string_view name) {
    if (!enabled()) return;
    const std::size_t pool = dispatches_.size() / k_dispatches_per_pool;
    const auto query = static_cast<std::uint32_t>(2 * (dispatches_.size() % k_dispatches_per_pool));
    if (pool == pools_.size()) add_pool();
    if (query == 0) vkCmdResetQueryPool(commands, pools_[pool].get(), 0, 2 * k_dispatches_per_pool);
    write(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pools_[pool].get(), query);
    dispatches_.emplace_back(name);
}

void Timestamps::stop(VkCommandBuffer commands, VkPipelineStageFlags2 stage) {
    if (!enabled()) return;
    const std::size_t last = dispatches_.size() - 1;
    write(commands, stage, pools_[last / k_dispatches_per_pool].get(),
          static_cast<std::uint32_t>(2 * (last % k_dispatches_per_pool) + 1));
}

std::uint64_t Timestamps::elapsed_ticks(std::size_t dispatch) const {
    std::array<std::uint64_t, 2> ticks{};
    check(vkGetQueryPoolResults(device_.handle(), pools_[dispatch / k_dispatches_per_pool].get(),
                                static_cast<std::uint32_t>(2 * (dispatch % k_dispatches_per_pool)), 2, sizeof ticks,
                                ticks.data(), sizeof ticks[0], VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
          "read timestamps");
    // Counters of fewer bits wrap around.
    const std::uint32_t bits = device_.info().timestamp_bits;
    return (ticks[1] - ticks[0]) & (bits < 64 ? (std::uint64_t{1} << bits) - 1 : ~std::uint64_t{0});
}

void Timestamps::collect() {
    if (profiler_) profiler_->add_submission();
    for (std::size_t i = 0; i < dispatches_.size(); ++i)
        profiler_->add(dispatches_[i], static_cast<double>(elapsed_ticks(i)) * device_.info().timestamp_period * 1e-6);
    clear();
}

}  // namespace exemplar
