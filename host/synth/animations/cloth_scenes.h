#pragma once

#include <functional>

#include "host/synth/animations/animations.h"
#include "host/synth/animations/cloth.h"

namespace exemplar {

/// A flag held at its left side in turbulent wind.
Animation make_flag(const AnimationOptions& options);
/// A curtain on rings that are pushed along their rod, in a draft.
Animation make_curtain(const AnimationOptions& options);
/// A sheet that falls over a ball, which moves and turns.
Animation make_drape(const AnimationOptions& options);
/// Returns the ball of make_drape as a function of the time in seconds.
std::function<Ball3(double)> drape_ball(const AnimationOptions& options);

}  // namespace exemplar
