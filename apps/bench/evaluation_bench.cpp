// bench_evaluation MODEL ANIMATION: what curvature costs per frame on one thread, learned and estimated anew, in
// milliseconds of CPU: medians over rounds that take both in turns on the same frames.

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include "host/animation/read_animation.h"
#include "host/core/parallel.h"
#include "host/curvature/evaluation.h"

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
    double of(const std::string& name) {
        std::vector<double>& samples = samples_.at(name);
        const auto middle = samples.begin() + static_cast<std::ptrdiff_t>(samples.size() / 2);
        std::nth_element(samples.begin(), middle, samples.end());
        return *middle;
    }
    bool has(const std::string& name) const { return samples_.contains(name); }

  private:
    std::map<std::string, std::vector<double>> samples_;
};

struct Frame {
    const Pose* pose;  // none of a mesh sequence
    SurfaceMoment moment;
};

std::vector<Frame> read_frames(const Animation& animation, const CurvatureModel& model) {
    MomentReader reader(animation, model.segments, model.truth);
    std::vector<Frame> frames;
    for (const FrameRef& at : select_frames(animation, {.clips = {}, .most = k_frames})) {
        const bool posed = animation.kind != AnimationKind::sequence;
        frames.push_back({posed ? &animation.clips[at.clip].poses[at.frame] : nullptr, reader.read(at)});
    }
    return frames;
}

// Pose, or local shape, to inputs.
void time_inputs(const CurvatureModel& model, const Frame& frame, std::span<float> x, Medians& medians) {
    if (!model.state.is_local()) {
        if (frame.pose) medians.time("pose", [&] { model.state.read_pose(*frame.pose, x); });
    } else {
        LocalShapeReader reader(model.state);
        std::vector<Eigen::Matrix3f> rotations;
        for (std::size_t round = 0; round < 2; ++round) {  // the first asks for memory
            medians.time("rotations", [&] { model.segments.rotations_of_sequence(frame.moment.vertices, rotations); });
            medians.time("shape", [&] { reader.read(frame.moment.vertices, frame.moment.normals, rotations, x); });
        }
    }
    medians.time("range", [&] { model.range.prepare(model.state, x); });
}

// The parts of a frame, each with warm caches: to inputs, inputs to components, components to curvature.
void time_parts(const CurvatureModel& model, const Frame& frame, std::span<const float> components, Medians& medians) {
    std::vector<float> x(model.state.input_count), features(model.regression.feature_count()),
        z(model.regression.components.size());
    VertexCurvature curvature;
    const PosedSurface surface = frame.moment.surface();
    reproject_curvature(model.tiles, components, surface, curvature);
    for (std::size_t round = 0; round < k_rounds; ++round) {
        time_inputs(model, frame, x, medians);
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
            evaluator.evaluate(animation.rig, *f.pose, f.moment.vertices, f.moment.normals);
        else
            evaluator.evaluate(f.moment.vertices, f.moment.normals);
    };
    for (std::size_t round = 0; round < k_rounds; ++round) {
        for (const Frame& f : frames) medians.time("learned", [&] { learn(f); });
        for (const Frame& f : frames) medians.time("estimated", [&] { estimator.estimate(f.moment.vertices); });
        for (std::size_t i = 0; i < frames.size() && round % 10 == 0; ++i)
            medians.time("smoothed", [&] { estimator.estimate(frames[i].moment.vertices, smoothed); });
    }
    for (const Frame& f : frames) time_parts(model, f, evaluator.components(), medians);
    return medians;
}

void run(const char* model_path, const char* animation_path) {
    const CurvatureModel model = load_curvature_model(model_path);
    const Animation animation = read_animation(animation_path);
    require_fit(model, animation);
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
