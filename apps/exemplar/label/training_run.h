#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/help/command.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/training/training.h"

namespace exemplar {

/// Adds --seed, --rounds and the other options of training to a subcommand.
void add_training_options(Command& command, TrainOptions& options, std::filesystem::path& cache);

/// Computes the features of all meshes of a corpus, with progress.
std::vector<MeshFeatures> features_of(const LabeledCorpus& corpus, const FeatureOptions& options,
                                      const std::filesystem::path& cache);

/// Features of training meshes that stay in memory, unless the user says otherwise.
constexpr double k_feature_gigabytes = 0.5;
/// The same, but only so many gigabytes stay in memory; the features of the other meshes are read from the cache
/// whenever training needs them. Features that the cache could not store stay in memory too. The corpus must outlive
/// the result, which refers to its meshes.
TrainingFeatures training_features(const LabeledCorpus& corpus, const FeatureOptions& options,
                                   const std::filesystem::path& cache, double gigabytes);
/// Adds --feature-memory, the gigabytes of training_features, to a subcommand.
void add_feature_memory_option(Command& command, double& gigabytes);

/// Returns the number of stumps of the unary cascade, or of its classifier `stage`, per feature family, most used
/// first.
std::vector<std::pair<std::string, std::size_t>> stumps_per_family(const LabelingModel& model,
                                                                   std::optional<std::size_t> stage = {});
/// Names of the features of the first `count` stumps of the first classifier.
std::vector<std::string> first_features(const LabelingModel& model, std::size_t count);

/// Everything but the meshes that a model depends on, for results that are kept: those of other options, or of another
/// version of the training, are not mixed.
nlohmann::json describe_options(const TrainOptions& options);

/// A table of the classifiers and the CRF's parameters.
void print_training(const LabelingModel& model, const TrainReport& report);
/// The same for --json; keys are documented in docs/formats.md.
nlohmann::json describe_training(const LabelingModel& model, const TrainReport& report);

}  // namespace exemplar
