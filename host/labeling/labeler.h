#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/labeling/features.h"
#include "host/labeling/model.h"
#include "host/learn/boosted_stumps.h"

namespace exemplar {

/// Where the heavy per-face work runs: the CPU references or their compute shaders.
struct LabelingBackend {
    StumpScorer& scorer;
    ContextHistograms& context;
};

/// What inference says about one mesh, per triangle.
struct FaceLabeling {
    std::vector<std::int32_t> label;                      ///< after the CRF and the merging of small pieces
    std::vector<float> probabilities;                     ///< faces x classes: what the unary cascade says
    std::vector<float> confidence;                        ///< probability of the assigned label
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time: unary, pairwise, cut
};

/// Names of the contextual columns that a cascade's later stages see, "context.MEASURE.BIN.LABEL".
std::vector<std::string> context_names(const std::vector<std::string>& label_names);
/// The boundary probability of every edge where training saw no boundary.
constexpr float k_even_odds = 0.5F;

/// Names of the pairwise contextual columns (thesis App. A.2e).
std::vector<std::string> edge_context_names();
/// P(boundary) per edge from two-class probabilities (edges x 2).
std::vector<float> boundary_column(std::span<const float> probabilities);
/// Gives `matrix` contextual columns of these names behind its `base` first ones (in place of any it had), and returns
/// them.
std::span<float> context_columns(FeatureMatrix& matrix, std::size_t base, const std::vector<std::string>& names);

/// Removes the contextual columns of both matrices.
void drop_context_columns(MeshFeatures& features);

/// Runs the unary cascade: faces x classes. `features.unary` gains (or reuses) the contextual columns.
/// Throws ModelError where the features are not those the model was trained on.
std::vector<float> unary_probabilities(const LabelingModel& model, MeshFeatures& features,
                                       const LabelingBackend& backend);
/// Runs the boundary classifiers: one probability per edge. `features.pairwise` gains the contextual columns.
std::vector<float> boundary_probabilities(const LabelingModel& model, MeshFeatures& features,
                                          const LabelingBackend& backend);
/// Labels a mesh (thesis Sec. 3.2).
FaceLabeling label_faces(const LabelingModel& model, MeshFeatures& features, const LabelingBackend& backend);

}  // namespace exemplar
