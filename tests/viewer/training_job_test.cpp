#include "apps/viewer/controls/training_job.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <string>
#include <thread>

#include "host/core/errors.h"
#include "host/synth/animations/animations.h"

namespace exemplar {
namespace {

Animation figure() {
    return make_animation("figure", {.vertices = 600, .frames = 24});
}

/// Calls `each` now and then until the job is finished.
template <typename Each>
void wait(const TrainingJob& job, const Each& each) {
    while (!job.finished()) {
        each();
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

TEST(TrainingJob, LearnsInTheBackgroundAndSaysHowFarItIs) {
    TrainingJob job(figure(), 1);
    std::set<std::string> steps;
    wait(job, [&] {
        const TrainingJob::Status status = job.status();
        steps.insert(status.what);
        EXPECT_GE(status.share, 0);
        EXPECT_LE(status.share, 1);
    });
    EXPECT_GE(steps.size(), 2u);
    EXPECT_NO_THROW(require_compatible(job.take(), figure()));
}

TEST(TrainingJob, EndsSoonWhenItIsCanceled) {
    TrainingJob job(make_animation("figure", {.vertices = 20000, .frames = 200}), 1);
    job.cancel();
    EXPECT_TRUE(job.canceled());
    wait(job, [] {});
    EXPECT_THROW(job.take(), Interrupted);
}

TEST(TrainingJob, MayBeLeftAndStartedAgain) {
    for (int i = 0; i < 3; ++i) TrainingJob(figure(), 1);
    TrainingJob last(figure(), 1);
    wait(last, [] {});
    EXPECT_NO_THROW(last.take());
}

TEST(TrainingJob, HandsOnWhatIsWrong) {
    Animation animation = figure();
    animation.clips.clear();
    TrainingJob job(animation, 1);
    wait(job, [] {});
    EXPECT_THROW(job.take(), Error);
}

}  // namespace
}  // namespace exemplar
