#pragma once

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>

namespace exemplar {

/// Bounds the memory of concurrent work: each piece of work takes a share first, and waits while the others hold too
/// much. Thread-safe.
class MemoryBudget {
  public:
    /// A part of the budget; the destructor gives it back.
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
        /// Changes the size of the share. Never waits, since waiting while holding a share could deadlock.
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
    /// Waits until the share fits into the budget. A share larger than the budget is granted once no other is held.
    /// Returns at once, whatever is held, if the budget was abandoned.
    Share take(std::size_t bytes);
    /// Ends all waiting, now and later.
    void abandon();

  private:
    std::mutex mutex_;
    std::condition_variable freed_;
    std::size_t bytes_, taken_ = 0;
    bool abandoned_ = false;
};

/// Returns the bytes of memory that this process may use: those of the machine, or the limit of its control groups
/// if that is lower.
std::size_t usable_memory();

/// Returns the bytes of memory that this process has now (on Linux; 0 elsewhere).
std::size_t resident_memory();

/// Returns the lowest memory limit in bytes of a process's control groups and their ancestors; the largest size_t if
/// none sets a limit. `groups` is the text of /proc/PID/cgroup, `root` the folder where control groups are mounted.
/// Reads memory.max (version 2) and memory.limit_in_bytes (version 1); groups that are not visible from here set no
/// limit.
std::size_t memory_limit(const std::string& groups, const std::filesystem::path& root);

}  // namespace exemplar
