#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <vector>

#include "apps/viewer/controls/background_job.h"
#include "apps/viewer/scene/hatched_still.h"

namespace exemplar {

/// Returns the files to write a still to.
using StillNames = std::function<std::vector<std::filesystem::path>()>;

/// Draws a hatched still in the background and writes it; the result is the list of files. Only one may run at a
/// time.
class HatchingJob final : public BackgroundJob<std::vector<std::filesystem::path>> {
  public:
    /// Calls `names` only when the drawing is ready, as other programs may use names before that.
    HatchingJob(HatchedStill still, StillNames names);
    ~HatchingJob() { end(); }

    /// The current step: a present participle.
    const char* what() const { return what_; }

  private:
    std::vector<std::filesystem::path> run(const HatchedStill& still, const StillNames& names);
    std::atomic<const char*> what_ = "beginning";
};

}  // namespace exemplar
