// bench_evaluation MODEL ANIMATION: cost of curvature per frame on one thread, learned and estimated anew, in
// milliseconds of CPU: medians over rounds that measure both in turns on the same frames.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host/animation/read_animation.h"
#include "host/core/parallel.h"
#include "host/core/statistics.h"
#include "host/curvature/model/evaluation.h"

namespace exemplar {
namespace {

constexpr std::size_t k_frames = 20, k_rounds = 50;

double thread_milliseconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

class Medians {
  public:
    template <typename Call>
    void time(const std::string& name, Call&& call) {
        const double begin = thread_milliseconds();
        call();
        samples_[name].push_back(thread_milliseconds() - begin);
    }
    double of(const std::string& name) { return upper_median(samples_.at(name)); }
    bool has(const std::string& name) const { return samples_.contains(name); }

  private:
    std::map<std::string, std::vector<double>> samples_;
};

struct Frame {
    const Pose* pose;  // none of a mesh sequence
    SurfaceSnapshot snapshot;
};

std::vector<Frame> read_frames(const Animation& animation, const CurvatureModel& model) {
    SnapshotReader reader(animation, model.segments, model.truth);
    std::vector<Frame> frames;
    for (const FrameRef& at : select_frames(animation, {.clips = {}, .most = k_frames})) {
        const bool posed = animation.kind != AnimationKind::sequence;
        frames.push_back({posed ? &animation.clips[at.clip].poses[at.frame] : nullptr, reader.read(at)});
    }
    return frames;
}

// Computes inputs from a pose or from local shape.
class InputParts {
  public:
    explicit InputParts(const CurvatureModel& model) : model_(model) {
        if (model.state.is_local()) local_.emplace(model.state);
    }
    void time(const Frame& frame, std::span<float> x, Medians& medians) {
        const SurfaceSnapshot& snapshot = frame.snapshot;
        if (local_) {
            medians.time("rotations", [&] { model_.segments.rotations_of_sequence(snapshot.vertices, rotations_); });
            medians.time("shape", [&] { local_->read(snapshot.vertices, snapshot.normals, rotations_, x); });
        } else if (frame.pose) {
            medians.time("pose", [&] { model_.state.read_pose(*frame.pose, x); });
        }
        medians.time("range", [&] { model_.range.prepare(model_.state, x); });
    }

  private:
    const CurvatureModel& model_;
    std::optional<LocalShapeReader> local_;
    std::vector<Eigen::Matrix3f> rotations_;
};

// Times the parts of a frame, each with warm caches: inputs, components from inputs, curvature from components.
void time_parts(const CurvatureModel& model, const Frame& frame, std::span<const float> components, Medians& medians) {
    std::vector<float> x(model.state.input_count), features(model.regression.feature_count()),
        z(model.regression.components.size());
    VertexCurvature curvature;
    const PosedSurface surface = frame.snapshot.surface();
    InputParts inputs(model);
    reproject_curvature(model.tiles, components, surface, curvature);
    for (std::size_t round = 0; round < k_rounds; ++round) {
        inputs.time(frame, x, medians);
        if (!model.regression.is_identity())
            medians.time("components", [&] { model.regression.evaluate(x, features, z); });
        medians.time("reprojection", [&] { reproject_curvature(model.tiles, components, surface, curvature); });
    }
}

Medians time_frames(const CurvatureModel& model, const Animation& animation) {
    const std::vector<Frame> frames = read_frames(animation, model);
    CurvatureEvaluator evaluator(model);
    CurvatureEstimator estimator(animation.rest.faces, model.vertex_count);
    const CurvatureOptions smoothed{.smoothing = model.truth.smoothing, .smoothing_unit = model.truth.smoothing_unit};
    Medians medians;
    const auto learn = [&](const Frame& f) {
        if (f.pose)
            evaluator.evaluate(animation.rig, *f.pose, f.snapshot.vertices, f.snapshot.normals);
        else
            evaluator.evaluate(f.snapshot.vertices, f.snapshot.normals);
    };
    for (std::size_t round = 0; round < k_rounds; ++round) {
        for (const Frame& f : frames) medians.time("learned", [&] { learn(f); });
        for (const Frame& f : frames) medians.time("estimated", [&] { estimator.estimate(f.snapshot.vertices); });
        for (std::size_t i = 0; i < frames.size() && round % 10 == 0; ++i)
            medians.time("smoothed", [&] { estimator.estimate(frames[i].snapshot.vertices, smoothed); });
    }
    for (const Frame& f : frames) time_parts(model, f, evaluator.components(), medians);
    return medians;
}

void run(const char* model_path, const char* animation_path) {
    const CurvatureModel model = load_curvature_model(model_path);
    const Animation animation = read_animation(animation_path);
    require_compatible(model, animation);
    const ThreadLimit one(1);
    Medians medians = time_frames(model, animation);
    fmt::print("{} vertices, {} components, {:.2f} components per tile and attribute, {:.2f} MB of tiles\n",
               model.vertex_count, model.regression.components.size(),
               static_cast<double>(model.tiles.basis.size()) / static_cast<double>(model.tiles.mean.size()),
               1e-6 * static_cast<double>(model.tiles.bytes()));
    const double learned = medians.of("learned");
    for (const char* name : {"estimated", "smoothed", "learned"})
        fmt::print("{:12} {:8.4f} ms {:8.1f} x learned\n", name, medians.of(name), medians.of(name) / learned);
    for (const char* name : {"pose", "rotations", "shape", "range", "components", "reprojection"})
        if (medians.has(name)) fmt::print("  {:12} {:8.4f} ms\n", name, medians.of(name));
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    if (count != 3) {
        std::fputs("usage: bench_evaluation MODEL ANIMATION\n", stderr);
        return 2;
    }
    try {
        exemplar::run(arguments[1], arguments[2]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}\n", error.what());
        return 1;
    }
    return 0;
}
