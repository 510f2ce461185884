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

/// Output of the classifiers for one mesh, before the graph cut.
struct FaceScores {
    std::vector<float> probabilities;  ///< faces x classes, from the unary cascade
    std::vector<float> boundary;       ///< P(boundary) per interior edge
    float turned = 0;  ///< degrees that the mesh had to be turned to lie like those of training; 0 without coordinates
    std::vector<std::pair<std::string, double>> seconds;  ///< its share of the wall time: unary, pairwise
};

/// Runs all classifiers of a model at once, where a device can keep what lies between them.
class CascadeScorer {
  public:
    virtual ~CascadeScorer() = default;
    /// Returns how many of the meshes, from the first on, can be scored together; 0 if the first cannot be scored here.
    virtual std::size_t fitting(const LabelingModel& model, std::span<MeshFeatures* const> meshes) const = 0;
    /// Scores meshes that fit. Each mesh gets the result that it would get alone, bit for bit on one device.
    virtual std::vector<FaceScores> score(const LabelingModel& model, std::span<MeshFeatures* const> meshes) = 0;
};

/// Implementations of the heavy per-face work: on the CPU (the references) or by compute shaders.
struct LabelingBackend {
    StumpScorer& scorer;
    ContextHistograms& context;
    CascadeScorer* cascade = nullptr;  ///< null: one classifier after the other
};

/// Result of inference for one mesh, per triangle.
struct FaceLabeling {
    std::vector<std::int32_t> label;   ///< after the CRF and the merging of small pieces
    std::vector<float> probabilities;  ///< faces x classes, from the unary cascade
    std::vector<float> confidence;     ///< probability of the assigned label
    std::vector<float> border;  ///< largest P(boundary) of the face's interior edges; empty without such a classifier
    float turned = 0;           ///< see FaceScores
    std::vector<std::pair<std::string, double>> seconds;  ///< wall time: unary, pairwise, cut
};

/// Returns the names of the contextual columns that a cascade's later stages see, "context.MEASURE.BIN.LABEL".
std::vector<std::string> context_names(const std::vector<std::string>& label_names);
/// Boundary probability of every edge if the model has no boundary classifiers, because training saw no boundary.
constexpr float k_unknown_boundary_probability = 0.5F;

/// Returns the names of the pairwise contextual columns (thesis App. A.2e).
std::vector<std::string> edge_context_names();
/// Returns P(boundary) per edge from two-class probabilities (edges x 2).
std::vector<float> boundary_column(std::span<const float> probabilities);
/// Replaces the columns of `matrix` after its first `base` ones by contextual columns of these names, and returns
/// them.
std::span<float> context_columns(FeatureMatrix& matrix, std::size_t base, const std::vector<std::string>& names);

/// Removes the columns that are not of the mesh alone: contextual ones of both matrices, and coordinates.
void drop_context_columns(MeshFeatures& features);

/// Throws ModelError if the features of a mesh are not those that the model was trained on.
void check_features(const LabelingModel& model, const MeshFeatures& features);
/// Adds to each mesh its share of the seconds that all took together, by number of faces.
void add_seconds(const char* stage, double seconds, std::span<FaceScores> scores);

// Labeling has two steps, so that many meshes can keep a device and the cores busy: the classifiers for several meshes
// together, then the graph cut of each mesh.

/// Runs all classifiers for several different meshes together, if memory suffices. Each mesh gets the result that it
/// would get alone, bit for bit on one device. Replaces columns that were appended to the features (is_appended) by
/// those of this model. Throws ModelError if the features of a mesh are not those that the model was trained on.
std::vector<FaceScores> score_faces(const LabelingModel& model, std::span<MeshFeatures* const> meshes,
                                    const LabelingBackend& backend);
/// Cuts a mesh into parts: the CRF on the result of score_faces, then the merging of small pieces. Runs on the host
/// alone; threads may cut different meshes at once.
FaceLabeling cut_faces(const LabelingModel& model, const MeshFeatures& features, FaceScores scores);
/// Labels a mesh (thesis Sec. 3.2): score_faces, then cut_faces.
FaceLabeling label_faces(const LabelingModel& model, MeshFeatures& features, const LabelingBackend& backend);

}  // namespace exemplar
