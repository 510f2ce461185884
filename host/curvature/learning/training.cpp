#include "host/curvature/learning/training.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/core/errors.h"
#include "host/core/stopwatch.h"
#include "host/curvature/learning/learn_local.h"
#include "host/curvature/learning/learners.h"
#include "host/curvature/state/augmentation.h"

namespace exemplar {

namespace {

/// Rings that curvature at a vertex depends on: one for the normals, one for the fit, and one for smoothing.
constexpr int k_surrounding_rings = 3;
/// A vertex varies if its curvature's deviation is at least this share of that of the vertex that varies most
/// (Sec. 5.4.1).
constexpr double k_min_curvature_variation = 0.005;

/// Computes (k1 + k2) / 2, which both sets of attributes contain: poses x vertices.
Eigen::MatrixXf mean_curvature(const TrainingSamples& samples) {
    const std::size_t second = samples.frames.set == AttributeSet::principal ? 1 : 2;
    return 0.5f * (samples.attributes[0] + samples.attributes[second]);
}

Eigen::MatrixXf mean_attributes(const TrainingSamples& samples) {
    Eigen::MatrixXf means(static_cast<Eigen::Index>(samples.attributes.size()), samples.attributes[0].cols());
    for (std::size_t a = 0; a < samples.attributes.size(); ++a)
        means.row(static_cast<Eigen::Index>(a)) = samples.attributes[a].colwise().mean();
    return means;
}

/// Returns whether the curvature at each vertex varies, from all attributes of second order together.
std::vector<bool> varying(AttributeSet set, const Eigen::MatrixXf& deviations) {
    Eigen::VectorXd deviation = Eigen::VectorXd::Zero(deviations.cols());
    for (Eigen::Index a = 0; a < deviations.rows(); ++a)
        if (!is_derivative(set, static_cast<std::size_t>(a)))
            deviation += deviations.row(a).transpose().cast<double>().cwiseAbs2();
    deviation = deviation.cwiseSqrt().eval();
    const double least = k_min_curvature_variation * percentile_99(deviation);
    std::vector<bool> varies;
    varies.reserve(static_cast<std::size_t>(deviation.size()));
    for (const double d : deviation) varies.push_back(d > least);
    return varies;
}

/// Removes the range limit of controls from which nothing is predicted, such as the heading of a figure.
void leave_out_unused(CurvatureModel& model) {
    constexpr float k_no_limit = 1e30f;
    std::vector<bool> used(model.state.input_count + 1, model.regression.neurons.rows() > 0);
    for (const Monomial& monomial : model.regression.monomials)
        for (const std::uint32_t input : monomial) used[input] = true;
    for (std::size_t c = 0; c < model.state.controls.size(); ++c) {
        const Control& control = model.state.controls[c];
        const auto first = used.begin() + control.first_input;
        if (std::find(first, first + control.input_count, true) == first + control.input_count)
            model.range.largest[c] = k_no_limit;
    }
}

double mean_controls(const std::vector<InfluenceGroup>& groups, const std::vector<bool>& varies) {
    double sum = 0, count = 0;
    for (const InfluenceGroup& group : groups)
        for (const std::uint32_t v : group.vertices)
            if (varies[v]) {
                sum += static_cast<double>(group.controls.size());
                ++count;
            }
    return count > 0 ? sum / count : 0;
}

void learn(const LearningTask& task, PredictorBuilder& builder) {
    switch (task.options.learner) {
        case Learner::additive:
            return learn_additive(task, builder);
        case Learner::averaged:
            return learn_averaged(task, builder);
        case Learner::network:
            return learn_network(task, builder);
        case Learner::global:
            return learn_global(task, builder);
        case Learner::local:
            break;  // its state is learned together with the map; see learn_local
    }
}

void require_learnable(const Animation& animation, std::span<const FrameRef> frames) {
    if (frames.size() < k_min_poses)
        throw UsageError(
            fmt::format("{}: {} poses are too few to learn from; at least {} are needed: name more clips "
                        "or frames",
                        animation.name, frames.size(), k_min_poses));
}

/// Returns a model with what is known before learning: its surface, and how curvature is measured.
CurvatureModel blank_model(const Animation& animation, FrameRef first, const CurvatureTraining& options) {
    CurvatureModel model;
    model.kind = animation.kind;
    model.vertex_count = animation.rest.vertex_count();
    model.topology = topology_hash(animation.rest.faces, model.vertex_count);
    model.truth = options.truth;
    if (model.truth.smoothing_unit <= 0)
        model.truth.smoothing_unit = CurvatureEstimator(animation.rest.faces, model.vertex_count)
                                         .median_edge_length(layout_shape(animation, first).vertices);
    return model;
}

void find_state(const Animation& animation, std::span<const FrameRef> frames, const CurvatureTraining& options,
                CurvatureModel& model) {
    if (options.attributes == AttributeSet::principal) model.segments = segment_animation(animation, frames);
    SequenceStateOptions sequence = options.sequence;
    if (options.learner == Learner::global) sequence.patch_vertices = 0;
    model.state = make_state(animation, frames, sequence);
    if (model.state.input_count == 0)
        throw UsageError(fmt::format("{}: nothing moves in the {} poses given; name other clips or frames",
                                     animation.name, frames.size()));
}

/// Trains with one of the learners whose state is determined before learning, i.e. all but local.
void learn_by_controls(const Animation& animation, std::span<const FrameRef> frames, const CurvatureTraining& options,
                       CurvatureModel& model, CurvatureTrainingReport& report) {
    Stopwatch watch;
    find_state(animation, frames, options, model);
    TrainingSamples samples =
        collect_samples(animation, model.segments, model.state, frames, options.attributes, model.truth);
    model.feature_size = samples.feature_size;
    model.range = make_pose_range(model.state, samples.states);
    // Centered, so that products of inputs are less correlated with their factors.
    samples.states.rowwise() -= model.range.mean.transpose();
    report.seconds_truth = watch.wall();

    watch = Stopwatch();
    LearningTask task{animation, model.state, samples, mean_attributes(samples), {}, {}, options};
    const Eigen::MatrixXf deviation = deviations(samples.attributes, task.means);
    task.scales = error_scales(deviation);
    const std::vector<bool> varies = varying(options.attributes, deviation);
    const std::vector<InfluenceGroup> possible = candidate_influences(animation, model.state, k_surrounding_rings);
    task.groups = significant_influences(possible, model.state, samples.states, mean_curvature(samples), varies, {});
    report.seconds_influence = watch.wall();

    watch = Stopwatch();
    PredictorBuilder builder(model.state.input_count);
    learn(task, builder);
    model.regression = builder.regression();
    leave_out_unused(model);
    model.tiles = make_tiles(samples.frames, layout_shape(animation, frames.front()).vertices, task.means,
                             builder.bases(), {.dropped_variance = options.dropped_variance, .scales = task.scales});
    report.seconds_fit = watch.wall();
    report.varying_vertices = static_cast<std::size_t>(std::count(varies.begin(), varies.end(), true));
    report.possible_controls = mean_controls(possible, varies);
    report.kept_controls = mean_controls(task.groups, varies);
}

/// Trains on frames of which the first `real` are of the animation and the others augmented.
CurvatureModel train_on(const Animation& animation, std::span<const FrameRef> frames, std::size_t real,
                        const CurvatureTraining& options, CurvatureTrainingReport& report) {
    CurvatureModel model = blank_model(animation, frames.front(), options);
    if (options.learner == Learner::local)
        learn_local(animation, frames, real, options, model, report);
    else
        learn_by_controls(animation, frames, options, model, report);
    return model;
}

/// Trains on the frames and augmented poses.
CurvatureModel train_augmented(Animation animation, std::vector<FrameRef> frames, const CurvatureTraining& options,
                               CurvatureTrainingReport& report) {
    const auto clip = static_cast<std::uint32_t>(animation.clips.size());
    const std::size_t real = frames.size();
    animation.clips.push_back(augmented_poses(animation, frames, options.augmented_poses, options.seed,
                                              options.learner == Learner::local ? k_wide_spread : PoseSpread{}));
    for (std::uint32_t i = 0; i < options.augmented_poses; ++i) frames.push_back({clip, i});
    report.poses += options.augmented_poses;
    return train_on(animation, frames, real, options, report);
}

}  // namespace

std::string_view name_of(Learner learner) {
    switch (learner) {
        case Learner::additive:
            return "additive";
        case Learner::averaged:
            return "averaged";
        case Learner::network:
            return "network";
        case Learner::local:
            return "local";
        case Learner::global:
            break;
    }
    return "global";
}

CurvatureModel train_curvature(const Animation& animation, std::span<const FrameRef> frames,
                               const CurvatureTraining& options, CurvatureTrainingReport& report) {
    require_learnable(animation, frames);
    report.poses = frames.size();
    const bool augments = animation.kind != AnimationKind::sequence && options.augmented_poses > 0;
    CurvatureModel model = augments ? train_augmented(animation, {frames.begin(), frames.end()}, options, report)
                                    : train_on(animation, frames, frames.size(), options, report);
    report.vertices = model.vertex_count;
    report.segments = model.segments.count();
    report.controls = model.state.controls.size();
    report.inputs = model.state.input_count;
    report.components = model.regression.components.size();
    report.model_bytes = model.tiles.bytes();
    return model;
}

}  // namespace exemplar
