#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <future>
#include <vector>

#include "apps/viewer/hatched_still.h"

namespace exemplar {

/// Draws a hatched still in the background and writes it. There may be one at a time.
class HatchingJob {
  public:
    struct Status {
        const char* what;  ///< a present participle
        double seconds;
    };

    /// Writes to all `files`.
    HatchingJob(HatchedStill still, std::vector<std::filesystem::path> files);
    /// Cancels it and waits, which takes moments.
    ~HatchingJob();
    HatchingJob(const HatchingJob&) = delete;
    HatchingJob& operator=(const HatchingJob&) = delete;

    Status status() const;
    void cancel() { canceled_ = true; }
    bool canceled() const { return canceled_; }
    bool finished() const;
    /// The files, once, when it is finished; throws what drawing threw, Interrupted if it was canceled.
    std::vector<std::filesystem::path> take() { return result_.get(); }

  private:
    std::vector<std::filesystem::path> run(const HatchedStill& still, const std::vector<std::filesystem::path>& files);
    std::atomic<bool> canceled_ = false;
    std::atomic<const char*> what_ = "beginning";
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::future<std::vector<std::filesystem::path>> result_;
};

}  // namespace exemplar
