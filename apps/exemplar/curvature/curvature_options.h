#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"

namespace exemplar {

/// Command-line arguments of learning curvature. Numbers are read into `training`; words and `dropped_variance` are
/// added by training_of().
struct CurvatureArguments {
    double frames_per_second = 30;
    CurvatureTraining training{};
    std::string robust = "none", learner = "local", attributes = "tensor", bases = "ica";
    std::optional<double> dropped_variance;  ///< none: chosen by the kind of animation
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
