#pragma once

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>

namespace exemplar {

/// Bounds the memory of work that is done at the same time: each piece takes a share before it begins, and waits while
/// the others have too much. Thread-safe.
class MemoryBudget {
  public:
    /// A part of the budget, given back when it ends.
    class Share {
      public:
        Share() = default;
        Share(Share&& other) noexcept { swap(other); }
        Share& operator=(Share&& other) noexcept {
            Share(std::move(other)).swap(*this);
            return *this;
        }
        Share(const Share&) = delete;
        Share& operator=(const Share&) = delete;
        ~Share();
        /// Now it is so many bytes; never waits, as waiting while holding might be forever.
        void resize(std::size_t bytes);

      private:
        friend class MemoryBudget;
        Share(MemoryBudget* budget, std::size_t bytes) : budget_(budget), bytes_(bytes) {}
        void swap(Share& other) noexcept {
            std::swap(budget_, other.budget_);
            std::swap(bytes_, other.bytes_);
        }
        MemoryBudget* budget_ = nullptr;
        std::size_t bytes_ = 0;
    };

    explicit MemoryBudget(std::size_t bytes) : bytes_(bytes) {}
    /// Waits until the share fits. One that is larger than the budget is had while there is no other. Nothing of the
    /// budget, at once, if it was abandoned.
    Share take(std::size_t bytes);
    /// Nobody waits any longer.
    void abandon();

  private:
    std::mutex mutex_;
    std::condition_variable freed_;
    std::size_t bytes_, taken_ = 0;
    bool abandoned_ = false;
};

/// Bytes of memory that this process may use: of the machine, or of its control groups if one of them has less.
std::size_t usable_memory();

/// The least that the control groups of a process, and those around them, leave it, in bytes; the largest number if
/// none sets a limit. `groups` is the text of /proc/PID/cgroup, `root` where control groups are mounted. Reads
/// memory.max (version 2) and memory.limit_in_bytes (version 1); groups that cannot be seen from here set none.
std::size_t memory_limit(const std::string& groups, const std::filesystem::path& root);

}  // namespace exemplar
