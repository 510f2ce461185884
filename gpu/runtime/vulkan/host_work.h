#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace exemplar {

/// Kinds of work that the host does for a device.
enum class HostTask : std::uint8_t {
    submission,      ///< a queue submission
    wait,            ///< the host stops until submitted work is done
    dispatch,        ///< a recorded dispatch
    pass,            ///< a recorded render pass
    barrier,         ///< a recorded pipeline barrier
    copy,            ///< a recorded copy command between buffers
    copied_region,   ///< a region of a copy command
    allocation,      ///< an allocation of device memory
    buffer,          ///< a buffer made
    view,            ///< a view of a buffer made
    descriptor_set,  ///< a descriptor set written
    byte_up,         ///< a byte from the host to the device
    byte_down,       ///< a byte from the device to the host
};
inline constexpr std::size_t k_host_tasks = 13;

/// The plural of a task, as a table's head: "submissions", "waits", ...
std::string_view plural_name(HostTask task);

/// Numbers of tasks done.
class HostWork {
  public:
    std::uint64_t operator[](HostTask task) const { return counts_[static_cast<std::size_t>(task)]; }
    std::uint64_t& operator[](HostTask task) { return counts_[static_cast<std::size_t>(task)]; }
    /// Returns what was done since `before`.
    HostWork since(const HostWork& before) const {
        HostWork difference = *this;
        for (std::size_t i = 0; i < k_host_tasks; ++i) difference.counts_[i] -= before.counts_[i];
        return difference;
    }

  private:
    std::array<std::uint64_t, k_host_tasks> counts_{};
};

/// Counts tasks. Any thread may use it.
class HostWorkCounter {
  public:
    void add(HostTask task, std::uint64_t count = 1) {
        counts_[static_cast<std::size_t>(task)].fetch_add(count, std::memory_order_relaxed);
    }
    HostWork total() const {
        HostWork work;
        for (std::size_t i = 0; i < k_host_tasks; ++i)
            work[static_cast<HostTask>(i)] = counts_[i].load(std::memory_order_relaxed);
        return work;
    }

  private:
    std::array<std::atomic<std::uint64_t>, k_host_tasks> counts_{};
};

}  // namespace exemplar
