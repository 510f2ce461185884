#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <vector>

#include "apps/viewer/controls/background_job.h"
#include "apps/viewer/scene/hatched_still.h"

namespace exemplar {

/// Gives the files that a still is written to.
using StillNames = std::function<std::vector<std::filesystem::path>()>;

/// Draws a hatched still in the background and writes it; its result are the files. There may be one at a time.
class HatchingJob final : public BackgroundJob<std::vector<std::filesystem::path>> {
  public:
    /// Asks for names when there is something to write, as others may take them until then.
    HatchingJob(HatchedStill still, StillNames names);
    ~HatchingJob() { end(); }

    /// What it is at: a present participle.
    const char* what() const { return what_; }

  private:
    std::vector<std::filesystem::path> run(const HatchedStill& still, const StillNames& names);
    std::atomic<const char*> what_ = "beginning";
};

}  // namespace exemplar
