#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// How curvature is predicted from the controls that influence a vertex.
///
/// additive: a sum of polynomials of the controls and of their pairs, fitted jointly; the part of each is then
/// reduced to a few components.
/// averaged (Sec. 5.4): the attributes of a control's vertices are reduced to components first. Each control
/// predicts them alone from its joint's and its parent joint's angles; predictions are averaged by their residuals
/// (Eq. 5.11).
/// network (Sec. 5.6, faces): one hidden layer from all inputs to the components.
/// global (Sec. 5.5, cloth): a polynomial of all inputs.
/// local: a linear map per patch from its normals and heights (see learn_local), for any kind of animation.
enum class Learner { additive, averaged, network, global, local };
std::string_view name_of(Learner learner);

struct CurvatureTraining {
    AttributeSet attributes = AttributeSet::tensor;
    Learner learner = Learner::local;
    bool independent = true;            ///< ICA bases, else PCA
    double variance = 0.99;             ///< share of the variance that bases keep
    SequenceStateOptions sequence{};    ///< state of mesh sequences; `global` takes the whole surface as one patch
    double dropped_variance = 0.001;    ///< left out by sparsity (see TilingOptions)
    std::size_t augmented_poses = 300;  ///< of rigs, in addition to the frames (see augmented_poses)
    CurvatureOptions truth{.derivatives = true, .smoothing = 1};
    std::uint64_t seed = 1;
};

struct CurvatureTrainingReport {
    std::size_t poses = 0;  ///< including augmented ones
    std::size_t vertices = 0, varying_vertices = 0, segments = 0, controls = 0, inputs = 0, components = 0;
    double possible_controls = 0, kept_controls = 0;  ///< per varying vertex: before and after the F-test
    std::size_t model_bytes = 0;                      ///< of the tiles
    double seconds_truth = 0, seconds_influence = 0, seconds_fit = 0;
};

/// Minimum number of poses to learn from: one more than the features of one joint's cubic polynomial
/// (learn_averaged).
constexpr std::size_t k_min_poses = 20;

/// Learns a model from frames of an animation. Throws UsageError if there are too few frames or nothing moves.
CurvatureModel train_curvature(const Animation& animation, std::span<const FrameRef> frames,
                               const CurvatureTraining& options, CurvatureTrainingReport& report);

}  // namespace exemplar
