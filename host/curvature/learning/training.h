#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// How curvature is predicted from the controls that matter to a vertex.
///
/// additive: the sum of a polynomial of each control, fitted together; the control's share of all vertices is then
/// reduced to a few components. averaged: the thesis' (Sec. 5.4): the attributes of the vertices that a control matters
/// to are reduced first, each control predicts them alone from its joint's and its parent's angles, and predictions are
/// averaged by their residuals (Eq. 5.11). network: the thesis' for faces (Sec. 5.6): one hidden layer from all inputs
/// to the components. global: the thesis' for cloth (Sec. 5.5): a polynomial of all inputs. local: a linear map of each
/// patch of the surface from its normals and heights (see learn_local), whatever moves it.
enum class Learner { additive, averaged, network, global, local };
std::string_view name_of(Learner learner);

struct CurvatureTraining {
    AttributeSet attributes = AttributeSet::tensor;
    Learner learner = Learner::local;
    bool independent = true;            ///< ICA bases, else PCA
    double variance = 0.99;             ///< kept by the bases of each control
    SequenceStateOptions sequence{};    ///< the state of mesh sequences; `global` takes the whole surface as one patch
    double dropped_variance = 0.001;    ///< left out by sparsity (see TilingOptions)
    std::size_t augmented_poses = 300;  ///< of rigs, beside the frames (see augmented_poses)
    CurvatureOptions truth{.derivatives = true, .smoothing = 1};
    std::uint64_t seed = 1;
};

struct CurvatureTrainingReport {
    std::size_t poses = 0;  ///< augmented ones included
    std::size_t vertices = 0, varying_vertices = 0, segments = 0, controls = 0, inputs = 0, components = 0;
    double possible_controls = 0, kept_controls = 0;  ///< per varying vertex: before and after the F-test
    std::size_t model_bytes = 0;                      ///< of the tiles
    double seconds_truth = 0, seconds_influence = 0, seconds_fit = 0;
};

/// The fewest poses that can be learned from: one more than the features of a cubic polynomial of one joint.
constexpr std::size_t k_fewest_poses = 20;

/// Learns a model from frames of an animation. Throws UsageError for too few frames or if nothing moves.
CurvatureModel train_curvature(const Animation& animation, std::span<const FrameRef> frames,
                               const CurvatureTraining& options, CurvatureTrainingReport& report);

}  // namespace exemplar
