#pragma once

#include <span>

#include "host/animation/animation.h"
#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"
#include "host/curvature/learning/training.h"

namespace exemplar {

/// Learns the curvature of a surface patch by patch from the shape of the patch and its surroundings: fills segments
/// (the patches), state, range, regression, tiles and feature_size of `model`, whose truth is set. `real` of the
/// frames, the first, are of the animation: predictions are exact where curvature and shape are at the mean of these,
/// whatever other poses follow. Throws UsageError if nothing moves.
void learn_local(const Animation& animation, std::span<const FrameRef> frames, std::size_t real,
                 const CurvatureTraining& options, CurvatureModel& model, CurvatureTrainingReport& report);

}  // namespace exemplar
