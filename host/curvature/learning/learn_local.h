#pragma once

#include <span>

#include "host/animation/animation.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/model/model.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// Learns the curvature of each patch of a surface from the local shape of the patch and its surroundings. Fills
/// segments (the patches), state, range, regression, tiles and feature_size of `model`, whose truth must be set. The
/// first `real` frames are of the animation, the others augmented: means are over the real ones, so that at their
/// mean shape the prediction is their mean curvature. Throws UsageError if nothing bends.
void learn_local(const Animation& animation, std::span<const FrameRef> frames, std::size_t real,
                 const CurvatureTraining& options, CurvatureModel& model, CurvatureTrainingReport& report);

}  // namespace exemplar
