#include "apps/viewer/controls/training_job.h"

#include <algorithm>
#include <utility>

#include "host/core/errors.h"
#include "host/core/progress.h"

namespace exemplar {

TrainingJob::TrainingJob(Animation animation, std::uint64_t seed) {
    Progress::set_listener([this](const ProgressState& state) {
        if (canceled()) throw Interrupted();
        const std::lock_guard lock(mutex_);
        status_.what = state.what;
        status_.share = static_cast<float>(state.done) / static_cast<float>(std::max<std::size_t>(state.total, 1));
    });
    start([this, animation = std::move(animation), seed] { return train(animation, seed); });
}

TrainingJob::~TrainingJob() {
    end();
    Progress::set_listener({});
}

CurvatureModel TrainingJob::train(const Animation& animation, std::uint64_t seed) {
    const std::vector<FrameRef> frames = select_frames(animation, {});
    CurvatureTraining options;
    options.seed = seed;
    // Cloth keeps all components, as on the command line: small ones in training may be large in other folds.
    if (animation.kind == AnimationKind::sequence) options.dropped_variance = 0;
    CurvatureTrainingReport report;
    CurvatureModel model = train_curvature(animation, frames, options, report);
    if (canceled()) throw Interrupted();
    model.training = {{"animation", animation.name}, {"poses", std::to_string(frames.size())}};
    return model;
}

TrainingJob::Status TrainingJob::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

}  // namespace exemplar
