#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "host/labeling/features/features.h"
#include "host/labeling/inference/linear_expert.h"
#include "host/learn/boosting/boosted_stumps.h"
#include "host/mesh/labels.h"

namespace exemplar {
/// Parameters of the CRF's pairwise term (thesis Eqs. 3.3, 3.4).
struct CrfParameters {
    double kappa = 1;   ///< weight of -log P(boundary)
    double lambda = 1;  ///< weight of the dihedral angle term
    double mu = 0.1;    ///< weight of boundary length
    /// L(c, c'), classes x classes, symmetric, zero diagonal, >= 0.
    std::vector<double> compatibility;
    /// A connected component is merged into a neighbor if its share of the surface is below this fraction of the
    /// smallest training component of its label. 0 turns merging off.
    double merge_fraction = 0.2;
};

/// Everything needed to label an unseen mesh.
struct LabelingModel {
    std::vector<std::string> label_names;
    std::vector<Color> label_colors;
    FeatureOptions feature_options;
    std::vector<std::string> unary_names;     ///< base features, in column order
    std::vector<std::string> pairwise_names;  ///< base features, in column order
    /// The cascade: stage 0 sees the base features, later stages also the contextual features of the stage before.
    std::vector<CalibratedStumps> unary;
    /// The linear classifier that each stage of the unary cascade is combined with; stages without an entry are stumps
    /// alone.
    std::vector<LinearExpert> linear;
    /// The first stage without coordinates, of a model with coordinates (uses_orientation): it tells how a mesh must be
    /// turned.
    CalibratedStumps unoriented;
    LinearExpert unoriented_linear;
    /// Labels that training saw in one fold only: their probabilities are the mean over all stages (CascadePrediction),
    /// without the linear classifiers.
    std::vector<std::uint32_t> averaged_labels;
    /// The cascade for boundaries (classes: 0 = same label, 1 = boundary).
    std::vector<CalibratedStumps> pairwise;
    CrfParameters crf;
    std::vector<float>
        smallest_component;  ///< per label: area share of its smallest training component, 0 if never seen
    std::uint64_t seed = 0;
    std::vector<std::string> provenance;  ///< one line per training mesh: name and content hash

    std::size_t class_count() const { return label_names.size(); }
};

/// Other versions are refused: 1 had no linear classifiers, 2 clamped their features at five deviations instead of two,
/// 3 had no classifier that tells how a mesh must be turned.
constexpr int k_model_format_version = 4;

/// Writes the whole model to a safetensors file; equal models give equal bytes.
void save_model(const std::filesystem::path& path, const LabelingModel& model);
/// Reads a model and checks all of it. Throws ModelError if the file is damaged, truncated, newer than this program,
/// made for features of another version, or no labeling model.
LabelingModel load_model(const std::filesystem::path& path);

}  // namespace exemplar
