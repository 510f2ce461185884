#pragma once

#include <cstdint>
#include <mutex>
#include <string>

#include "apps/viewer/controls/background_job.h"
#include "host/animation/animation.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// Learns the curvature of an animation in the background, with the defaults of `exemplar curvature train`. Only one
/// may run at a time.
class TrainingJob final : public BackgroundJob<CurvatureModel> {
  public:
    struct Status {
        std::string what;  ///< current step, a present participle
        float share = 0;   ///< of that step, in [0, 1]
    };

    TrainingJob(Animation animation, std::uint64_t seed);
    ~TrainingJob();

    Status status() const;

  private:
    CurvatureModel train(const Animation& animation, std::uint64_t seed);
    mutable std::mutex mutex_;
    Status status_{.what = "reading poses"};
};

}  // namespace exemplar
