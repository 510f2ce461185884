#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "host/labeling/features/features.h"
#include "host/labeling/inference/model.h"
#include "host/learn/boosting/boosted_stumps.h"

namespace exemplar {

/// Where the heavy per-face work runs: the CPU references or their compute shaders.
struct LabelingBackend {
    StumpScorer& scorer;
    ContextHistograms& context;
};

/// What the classifiers say about one mesh, before the cut.
struct FaceScores {
    std::vector<float> probabilities;                     ///< faces x classes: what the unary cascade says
    std::vector<float> boundary;                          ///< P(boundary) per interior edge
    std::vector<std::pair<std::string, double>> seconds;  ///< its share of the wall time: unary, pairwise
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

// Labeling in two steps, so that many meshes keep a device and the cores busy: the classifiers for several meshes
// together, then the cut of each.

/// Runs all classifiers for several meshes (distinct ones): a submission to the device per classifier and histograms
/// where it has room, whatever the number of meshes. Each mesh gets what it would get alone, bit for bit on one device;
/// its features gain (or reuse) the contextual columns. Throws ModelError where the features of one are not those the
/// model was trained on.
std::vector<FaceScores> score_faces(const LabelingModel& model, std::span<MeshFeatures* const> meshes,
                                    const LabelingBackend& backend);
/// Cuts a mesh into parts by what score_faces said about it. On the host alone; threads may cut different meshes at
/// once.
FaceLabeling cut_faces(const LabelingModel& model, const MeshFeatures& features, FaceScores scores);
/// Labels a mesh (thesis Sec. 3.2): score_faces, then cut_faces.
FaceLabeling label_faces(const LabelingModel& model, MeshFeatures& features, const LabelingBackend& backend);

}  // namespace exemplar
