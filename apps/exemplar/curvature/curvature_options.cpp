#include "apps/exemplar/curvature/curvature_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "host/core/text.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {
namespace {

const Choices<RobustEstimator> k_robust_names{{"none", RobustEstimator::none},
                                              {"cauchy", RobustEstimator::cauchy},
                                              {"geman-mcclure", RobustEstimator::geman_mcclure}};
const Choices<Learner> k_learner_names = [] {
    Choices<Learner> names;
    for (const Learner learner :
         {Learner::additive, Learner::averaged, Learner::network, Learner::global, Learner::local})
        names.emplace_back(name_of(learner), learner);
    return names;
}();
const Choices<AttributeSet> k_attribute_names{{"tensor", AttributeSet::tensor}, {"principal", AttributeSet::principal}};
const Choices<bool> k_independent_names{{"ica", true}, {"pca", false}};

/// Components of little variance in training are also small in other motions of a rig, but not in other folds of
/// cloth.
double suitable_sparsity(AnimationKind kind) {
    return kind == AnimationKind::sequence ? 0 : CurvatureTraining{}.dropped_variance;
}

}  // namespace

void add_curvature_options(Command& command, CurvatureArguments& arguments) {
    CurvatureTraining& training = arguments.training;
    command.add_option("--fps", arguments.frames_per_second, k_fps_option)
        ->capture_default_str()
        ->check(in_range(0.1, 1000.0));
    command
        .add_option("--smoothing", training.truth.smoothing,
                    "width of the diffusion of measured curvature, in median edge lengths; 0 is none")
        ->capture_default_str()
        ->check(in_range(0.0, 20.0));
    add_choice(command, "--robust", training.truth.robust, k_robust_names,
               "estimator for noisy meshes: none, cauchy or geman-mcclure")
        ->default_str(word_of(training.truth.robust, k_robust_names));
    add_choice(command, "--learner", training.learner, k_learner_names,
               "local, additive (rigs), or averaged, network, global (as in the thesis)")
        ->default_str(word_of(training.learner, k_learner_names));
    add_choice(command, "--attributes", training.attributes, k_attribute_names,
               "tensor: seven numbers that stay smooth; principal: the thesis' eight")
        ->default_str(word_of(training.attributes, k_attribute_names));
    add_choice(command, "--bases", training.independent, k_independent_names, "ica or pca")
        ->default_str(word_of(training.independent, k_independent_names));
    command.add_option("--variance", training.variance, "share of the variance that bases keep")
        ->capture_default_str()
        ->check(in_range(0.01, 1.0));
    command
        .add_option("--sparsity", arguments.dropped_variance,
                    "share of what the bases explain that is left out to make the model smaller; default: 0.001, or 0 "
                    "for mesh sequences")
        ->check(in_range(0.0, 0.5));
    command
        .add_option(
            "--augment", training.augmented_poses,
            "rigs: poses to learn from beside the frames, in which joints or shapes of different frames are mixed")
        ->capture_default_str()
        ->check(whole_number(0, 100000));
    command
        .add_option("--patch", training.sequence.patch_vertices,
                    "vertices of the patches whose shapes are told apart, at most; 0 takes the whole surface")
        ->capture_default_str()
        ->check(whole_number(0));
    command.add_option("--patch-inputs", training.sequence.max_inputs, "most numbers that describe a patch")
        ->capture_default_str()
        ->check(whole_number(1, 1000));
    command
        .add_option("--state-variance", training.sequence.share,
                    "mesh sequences: share of the variance of the dihedral angles that these numbers keep")
        ->capture_default_str()
        ->check(in_range(0.01, 1.0));
    command.add_option("--seed", training.seed, "seed of all random choices; equal seeds give equal model files")
        ->capture_default_str()
        ->check(whole_number(0));
}

CurvatureTraining training_of(const CurvatureArguments& arguments, AnimationKind kind) {
    CurvatureTraining training = arguments.training;
    training.dropped_variance = arguments.dropped_variance.value_or(suitable_sparsity(kind));
    training.sequence.seed = training.seed;
    return training;
}

std::map<std::string, std::string> training_words(const CurvatureTraining& training) {
    return {{"smoothing", fmt::format("{}", training.truth.smoothing)},
            {"robust", word_of(training.truth.robust, k_robust_names)},
            {"learner", word_of(training.learner, k_learner_names)},
            {"attributes", word_of(training.attributes, k_attribute_names)},
            {"bases", word_of(training.independent, k_independent_names)},
            {"variance", fmt::format("{}", training.variance)},
            {"sparsity", fmt::format("{}", training.dropped_variance)},
            {"augment", std::to_string(training.augmented_poses)},
            {"patch", std::to_string(training.sequence.patch_vertices)},
            {"patch-inputs", std::to_string(training.sequence.max_inputs)},
            {"state-variance", fmt::format("{}", training.sequence.share)},
            {"seed", std::to_string(training.seed)}};
}

nlohmann::json describe_training(const CurvatureTrainingReport& report) {
    return {{"poses", report.poses},
            {"vertices", report.vertices},
            {"varying_vertices", report.varying_vertices},
            {"segments", report.segments},
            {"controls", report.controls},
            {"inputs", report.inputs},
            {"components", report.components},
            {"controls_per_vertex", {{"possible", report.possible_controls}, {"kept", report.kept_controls}}},
            {"tile_bytes", report.model_bytes},
            {"seconds",
             {{"truth", report.seconds_truth}, {"influence", report.seconds_influence}, {"fit", report.seconds_fit}}}};
}

nlohmann::json describe_evaluation(const CurvatureEvaluation& evaluation) {
    nlohmann::json attributes = nlohmann::json::object(), lines = nlohmann::json::object();
    for (const AttributeError& error : evaluation.attributes)
        attributes[error.name] = {{"rms", error.rms},
                                  {"percentile_95", error.percentile_95},
                                  {"zero_order_rms", error.zero_order_rms},
                                  {"zero_order_percentile_95", error.zero_order_percentile_95},
                                  {"truth_rms", error.truth_rms}};
    for (const LineError& error : evaluation.lines)
        lines[std::string(name_of(error.type))] = {{"faces_with_line", error.truth},
                                                   {"misclassified", error.misclassified},
                                                   {"zero_order_misclassified", error.zero_order}};
    return {{"frames", evaluation.frames},
            {"attributes", attributes},
            {"lines", lines},
            {"farthest_pose", evaluation.farthest_pose},
            {"farthest_control", evaluation.farthest_control},
            {"far_frames", evaluation.far_frames}};
}

void print_evaluation(const CurvatureEvaluation& evaluation) {
    fmt::print("{:<24}{:>12}{:>12}{:>14}{:>14}\n", "faces with a line, %", "truth", "wrong", "zero order", "ratio");
    for (const LineError& line : evaluation.lines)
        fmt::print("{:<24}{:>12.2f}{:>12.2f}{:>14.2f}{:>14.2f}\n", name_of(line.type), 100 * line.truth,
                   100 * line.misclassified, 100 * line.zero_order,
                   line.zero_order > 0 ? line.misclassified / line.zero_order : 0.0);
    fmt::print("{:<24}{:>12}{:>12}{:>14}{:>14}\n", "error", "RMS", "95 %", "zero order", "truth's RMS");
    for (const AttributeError& error : evaluation.attributes)
        fmt::print("{:<24}{:>12.4g}{:>12.4g}{:>14.4g}{:>14.4g}\n", error.name, error.rms, error.percentile_95,
                   error.zero_order_rms, error.truth_rms);
    fmt::print(
        "{}; the farthest pose is {:.2f} times as far from the mean as any in training ('{}'); beyond {:.1f}: {}\n",
        counted(evaluation.frames, "frame"), evaluation.farthest_pose,
        mesh_io::printable(evaluation.farthest_control, 100), k_far_pose, counted(evaluation.far_frames, "frame"));
}

}  // namespace exemplar
