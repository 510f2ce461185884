#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/curvature/model/evaluation.h"
#include "host/curvature/learning/training.h"

namespace exemplar {

/// How to learn curvature, as words on the command line.
struct CurvatureArguments {
    double frames_per_second = 30;
    double smoothing = 1;
    std::string robust = "none", learner = "local", attributes = "tensor", bases = "ica";
    double variance = CurvatureTraining{}.variance;
    std::optional<double> dropped_variance;  ///< none: what suits the animation
    std::size_t augmented_poses = CurvatureTraining{}.augmented_poses;
    std::size_t patch_vertices = SequenceStateOptions{}.patch_vertices,
                patch_inputs = SequenceStateOptions{}.most_inputs;
    double state_variance = SequenceStateOptions{}.share;
    std::uint64_t seed = 1;
};

void add_curvature_options(CLI::App& command, CurvatureArguments& arguments);
/// `kind` decides what suits where nothing is named.
CurvatureTraining training_of(const CurvatureArguments& arguments, AnimationKind kind);

/// The arguments that decide what is learned, by the names of their options: what a model file keeps of its training.
std::map<std::string, std::string> words_of(const CurvatureArguments& arguments, AnimationKind kind);

nlohmann::json describe_training(const CurvatureTrainingReport& report);
nlohmann::json describe_evaluation(const CurvatureEvaluation& evaluation);
void print_evaluation(const CurvatureEvaluation& evaluation);

}  // namespace exemplar
