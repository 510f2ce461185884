// The rows of `exemplar bench` about the curvature of animated surfaces: learned beside estimated anew each frame.

#include <fmt/format.h>

#include "apps/exemplar/bench/bench_rows.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"
#include "host/synth/animations/animations.h"

namespace exemplar {
namespace {

/// The median of single frames, each measured by itself: one alone is over before clocks and caches settle.
Cost per_frame(std::size_t runs, std::size_t frames, const std::function<void(std::size_t)>& frame) {
    Cost cost = measure_single_thread(runs, [&] {
        for (std::size_t i = 0; i < frames; ++i) frame(i);
    });
    for (double* seconds : {&cost.wall, &cost.cpu}) *seconds /= static_cast<double>(frames);
    return cost;
}

struct Moments {
    std::vector<SurfaceSnapshot> moments;
    Cost estimated, diffused;
};

/// The unseen frames, and what measuring their curvature costs.
Moments measure_estimation(const BenchContext& context, const BenchCharacter& character, const CurvatureModel& model) {
    SnapshotReader reader(character.unseen, model.segments, model.truth);
    Moments result;
    for (const FrameRef& frame : character.unseen_frames) result.moments.push_back(reader.read(frame));
    CurvatureEstimator estimator(character.unseen.rest.faces, model.vertex_count);
    const auto estimate = [&](double smoothing) {
        return per_frame(3 * context.runs(), result.moments.size(), [&](std::size_t i) {
            estimator.estimate(result.moments[i].vertices,
                               {.smoothing = smoothing, .smoothing_unit = model.truth.smoothing_unit});
        });
    };
    result.estimated = estimate(0);
    result.diffused = estimate(model.truth.smoothing);
    return result;
}

void bench_learner(BenchContext& context, const BenchCharacter& character, Learner learner,
                   const std::function<void(const BenchRow&)>& row) {
    CurvatureModel model;
    CurvatureTrainingReport report;
    const Cost training = measure(
        1, [&] { model = train_curvature(character.seen, character.seen_frames, {.learner = learner}, report); });
    row({.name = "curvature",
         .what = fmt::format("training, {}, 100 poses of 20k vertices", name_of(learner)),
         .goal = "2 min",
         .cost = training,
         .remarks = {fmt::format("{:.2f} MB of bases and means", 1e-6 * static_cast<double>(report.model_bytes))},
         .numbers = {{"bytes", report.model_bytes}}});
    const Moments moments = measure_estimation(context, character, model);
    CurvatureEvaluator evaluator(model);
    const Cost learned = per_frame(3 * context.runs(), moments.moments.size(), [&](std::size_t i) {
        const FrameRef& frame = character.unseen_frames[i];
        evaluator.evaluate(character.unseen.rig, character.unseen.clips[frame.clip].poses[frame.frame],
                           moments.moments[i].vertices, moments.moments[i].normals);
    });
    row({.name = "curvature",
         .what = "estimated with derivatives, 20k vertices, one thread",
         .others = "trimesh2 17.8 ms",
         .cost = moments.estimated});
    row({.name = "curvature", .what = "the same with its diffusion", .cost = moments.diffused});
    const double speedup = moments.estimated.cpu / learned.cpu, diffused = moments.diffused.cpu / learned.cpu;
    row({.name = "curvature",
         .what = fmt::format("learned, {}, given vertices and normals, one thread", name_of(learner)),
         .goal = "a fifteenth of estimated, a fiftieth of diffused",
         .cost = learned,
         .remarks = {fmt::format("{:.1f} times as fast as estimated, {:.1f} times as diffused", speedup, diffused)},
         .numbers = {{"speedup", speedup}, {"speedup_diffused", diffused}}});
    if (learner == Learner::local) context.set_curvature_model(std::move(model));
}

/// Motions 1 and 2 of the figure.
Animation motion(std::uint64_t seed) {
    return make_animation("figure", {.vertices = 20'000, .frames = 100, .motion_seed = seed});
}

}  // namespace

const BenchCharacter& BenchContext::character() {
    if (!character_) {
        character_ = BenchCharacter{motion(1), motion(2), {}, {}};
        character_->seen_frames = select_frames(character_->seen, {});
        character_->unseen_frames = select_frames(character_->unseen, {.clips = {}, .most = 20});
    }
    return *character_;
}

const CurvatureModel& BenchContext::curvature_model() {
    if (!curvature_model_) {
        CurvatureTrainingReport report;
        const std::vector<FrameRef> some = select_frames(character().seen, {.clips = {}, .most = 40});
        curvature_model_ = train_curvature(character().seen, some, {.augmented_poses = 40}, report);
    }
    return *curvature_model_;
}

void bench_curvature(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    for (const Learner learner : {Learner::local, Learner::additive})
        bench_learner(context, context.character(), learner, row);
}

}  // namespace exemplar
