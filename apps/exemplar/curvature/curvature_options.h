#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"

namespace exemplar {

/// Command-line arguments of learning curvature.
struct CurvatureArguments {
    double frames_per_second = 30;
    double smoothing = 1;
    std::string robust = "none", learner = "local", attributes = "tensor", bases = "ica";
    double variance = CurvatureTraining{}.variance;
    std::optional<double> dropped_variance;  ///< none: chosen by the kind of animation
    std::size_t augmented_poses = CurvatureTraining{}.augmented_poses;
    std::size_t patch_vertices = SequenceStateOptions{}.patch_vertices,
                patch_inputs = SequenceStateOptions{}.max_inputs;
    double state_variance = SequenceStateOptions{}.share;
    std::uint64_t seed = 1;
};

void add_curvature_options(CLI::App& command, CurvatureArguments& arguments);
/// Returns the training options; `kind` decides those that are not given.
CurvatureTraining training_of(const CurvatureArguments& arguments, AnimationKind kind);

/// Returns the arguments that affect what is learned, by the names of their options, for storage in a model file.
std::map<std::string, std::string> training_words(const CurvatureArguments& arguments, AnimationKind kind);

nlohmann::json describe_training(const CurvatureTrainingReport& report);
nlohmann::json describe_evaluation(const CurvatureEvaluation& evaluation);
void print_evaluation(const CurvatureEvaluation& evaluation);

}  // namespace exemplar
