#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

namespace exemplar {

/// The progress of a task.
struct ProgressState {
    std::string what;
    std::size_t done = 0, total = 0;
};

/// Reports the progress of a long task and the time left to stderr: one line rewritten in place on a terminal, a
/// line every few seconds elsewhere. Thread-safe. A default-constructed object is silent and costs nothing.
class Progress {
  public:
    Progress() = default;
    /// total: number of steps; what: a short present participle, e.g. "computing features".
    Progress(std::string what, std::size_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// Adds `steps` to the steps done; `detail` names the current item.
    void advance(std::size_t steps = 1, const std::string& detail = {});
    /// Ends the line; the destructor does it too.
    void finish();

    /// Sends all progress to `listener` instead of stderr; an empty one restores stderr. The working threads call
    /// it, one at a time per task; it may throw to end the task.
    static void set_listener(std::function<void(const ProgressState&)> listener);

    /// Turns all progress output off or on (programs set it from --quiet).
    static void set_quiet(bool quiet);

  private:
    void print(bool last);
    std::mutex mutex_;
    std::string what_, detail_;
    std::size_t total_ = 0, done_ = 0;
    std::chrono::steady_clock::time_point start_{}, printed_{};
    bool finished_ = true;
    bool on_terminal_ = false;
};

}  // namespace exemplar
