#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "host/labeling/evaluation/evaluation.h"
#include "host/labeling/inference/model.h"

namespace exemplar {

// The parts of the report of `label evaluate` (docs/formats.md) beyond the scores of single meshes, and their
// printing.

/// A number per tested mesh, averaged per category.
struct Rate {
    const char* key;     ///< in the report
    const char* title;   ///< on the page
    const char* column;  ///< in the printed table
    bool lower_is_better;
    bool share;  ///< in [0, 1], shown in percent
};
/// All rates, those of labels first.
std::span<const Rate> evaluation_rates();

/// A rate of a report; NaN where it is null.
double rate_of(const nlohmann::json& json, const char* key);
/// Returns a rate as JSON; null for NaN.
nlohmann::json rate_json(double rate);
/// The rates of a mesh, with those of the classifiers alone (`uncut`).
nlohmann::json describe_scores(const MeshScore& labels, const MeshScore& uncut, const SegmentationErrors& segments);
/// Returns the mean of each rate over the items that have it.
nlohmann::json mean_rates(const nlohmann::json& items);

/// Per classifier of the unary cascade `stage`, `stumps` and `share_per_family` (thesis Fig. 3.5).
nlohmann::json chosen_features(const LabelingModel& model);
/// The same over several models.
nlohmann::json sum_chosen_features(const nlohmann::json& models);

/// Returns `names`, `confusion` (mean over meshes) and `confused` (the pairs of largest area) of test meshes, whose
/// label names may differ.
nlohmann::json confusion_of(const nlohmann::json& meshes);

/// Prints the tables of rates, confused labels and chosen features.
void print_evaluation(const nlohmann::json& report);

}  // namespace exemplar
