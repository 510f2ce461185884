// The rows of `exemplar bench` about the curvature of animated surfaces: learned beside estimated anew each frame.

#include <fmt/format.h>

#include "apps/exemplar/bench_rows.h"
#include "host/curvature/evaluation.h"
#include "host/curvature/training.h"
#include "host/synth/animations.h"

namespace exemplar {
namespace {

/// A generated character of 20,000 vertices that moves, and moves otherwise.
struct Character {
    Animation seen = motion(1), unseen = motion(2);
    std::vector<FrameRef> seen_frames = select_frames(seen, {}), unseen_frames = select_frames(unseen, {.most = 20});

    static Animation motion(std::uint64_t seed) {
        return make_animation("figure", {.vertices = 20'000, .frames = 100, .motion_seed = seed});
    }
};

/// The median of single frames, each measured by itself: one alone is over before clocks and caches settle.
Cost per_frame(std::size_t runs, std::size_t frames, const std::function<void(std::size_t)>& frame) {
    Cost cost = measure_single_thread(runs, [&] {
        for (std::size_t i = 0; i < frames; ++i) frame(i);
    });
    for (double* seconds : {&cost.wall, &cost.cpu}) *seconds /= static_cast<double>(frames);
    return cost;
}

void bench_frames(BenchContext& context, const Character& character, const CurvatureModel& model,
                  const std::function<void(const BenchRow&)>& row) {
    const std::size_t count = character.unseen_frames.size(), runs = 3 * context.runs();
    MomentReader reader(character.unseen, model.segments, model.truth);
    std::vector<SurfaceMoment> moments;
    for (const FrameRef& frame : character.unseen_frames) moments.push_back(reader.read(frame));
    CurvatureEstimator estimator(character.unseen.rest.faces, model.vertex_count);
    const auto estimate = [&](double smoothing) {
        return per_frame(runs, count, [&](std::size_t i) {
            estimator.estimate(moments[i].vertices,
                               {.smoothing = smoothing, .smoothing_unit = model.truth.smoothing_unit});
        });
    };
    CurvatureEvaluator evaluator(model);
    const Cost learned = per_frame(runs, count, [&](std::size_t i) {
        const FrameRef& frame = character.unseen_frames[i];
        evaluator.evaluate(character.unseen.rig, character.unseen.clips[frame.clip].poses[frame.frame],
                           moments[i].vertices, moments[i].normals);
    });
    const Cost plain = estimate(0), smoothed = estimate(model.truth.smoothing);
    row({.name = "curvature",
         .what = "estimated with derivatives, 20k vertices, one thread",
         .others = "trimesh2 17.8 ms",
         .cost = plain});
    row({.name = "curvature", .what = "the same with its diffusion", .cost = smoothed});
    row({.name = "curvature",
         .what = "learned, given vertices and normals, one thread",
         .goal = "a fifteenth of estimated, a fiftieth of diffused",
         .cost = learned,
         .remarks = {fmt::format("{:.1f} times as fast as estimated, {:.1f} times as diffused", plain.cpu / learned.cpu,
                                 smoothed.cpu / learned.cpu)},
         .numbers = {{"speedup", plain.cpu / learned.cpu}, {"speedup_diffused", smoothed.cpu / learned.cpu}}});
}

}  // namespace

void bench_curvature(BenchContext& context, const std::function<void(const BenchRow&)>& row) {
    const Character character;
    CurvatureModel model;
    CurvatureTrainingReport report;
    const Cost training =
        measure(1, [&] { model = train_curvature(character.seen, character.seen_frames, {}, report); });
    row({.name = "curvature",
         .what = "training, 100 poses of 20k vertices",
         .goal = "2 min",
         .cost = training,
         .remarks = {fmt::format("{:.2f} MB of bases and means", 1e-6 * static_cast<double>(report.model_bytes))},
         .numbers = {{"bytes", report.model_bytes}}});
    bench_frames(context, character, model, row);
}

}  // namespace exemplar
