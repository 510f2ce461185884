#pragma once

#include <atomic>
#include <filesystem>
#include <vector>

#include "apps/viewer/controls/background_job.h"
#include "apps/viewer/hatched_still.h"

namespace exemplar {

/// Draws a hatched still in the background and writes it; its result are the files. There may be one at a time.
class HatchingJob final : public BackgroundJob<std::vector<std::filesystem::path>> {
  public:
    /// Writes to all `files`.
    HatchingJob(HatchedStill still, std::vector<std::filesystem::path> files);
    ~HatchingJob() { end(); }

    /// What it is at: a present participle.
    const char* what() const { return what_; }

  private:
    void run(const HatchedStill& still, const std::vector<std::filesystem::path>& files);
    std::atomic<const char*> what_ = "beginning";
};

}  // namespace exemplar
