#pragma once

#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <string>

#include "host/animation/animation.h"
#include "host/curvature/model.h"
#include "host/curvature/training.h"

namespace exemplar {

/// Learns the curvature of an animation in the background, as `exemplar curvature train` does by itself. There may be
/// one at a time.
class TrainingJob {
  public:
    struct Status {
        std::string what;  ///< a present participle
        float share = 0;   ///< of that step, in [0, 1]
        double seconds = 0;
    };

    TrainingJob(Animation animation, std::uint64_t seed);
    /// Cancels it and waits, which takes moments.
    ~TrainingJob();
    TrainingJob(const TrainingJob&) = delete;
    TrainingJob& operator=(const TrainingJob&) = delete;

    Status status() const;
    void cancel() { canceled_ = true; }
    bool canceled() const { return canceled_; }
    bool finished() const;
    /// The model, once, when it is finished; throws what training threw, Interrupted if it was canceled.
    CurvatureModel take() { return result_.get(); }

  private:
    CurvatureModel train(const Animation& animation, std::uint64_t seed);
    std::atomic<bool> canceled_ = false;
    mutable std::mutex mutex_;
    Status status_{.what = "reading poses"};
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    std::future<CurvatureModel> result_;
};

}  // namespace exemplar
