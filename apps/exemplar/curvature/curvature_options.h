#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/help/command.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/evaluation.h"

namespace exemplar {

/// Command-line arguments of learning curvature.
struct CurvatureArguments {
    CurvatureTraining training;              ///< without what training_of() adds
    std::optional<double> dropped_variance;  ///< none: chosen by the kind of animation
    double frames_per_second = 30;
};

void add_curvature_options(Command& command, CurvatureArguments& arguments);
/// Returns the training options; `kind` decides those that are not given.
CurvatureTraining training_of(const CurvatureArguments& arguments, AnimationKind kind);

/// Returns the options that affect what is learned, by their names on the command line, for storage in a model file.
std::map<std::string, std::string> training_words(const CurvatureTraining& training);

nlohmann::json describe_training(const CurvatureTrainingReport& report);
nlohmann::json describe_evaluation(const CurvatureEvaluation& evaluation);
void print_evaluation(const CurvatureEvaluation& evaluation);

}  // namespace exemplar
