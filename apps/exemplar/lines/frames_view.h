#pragma once

#include <span>

#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// Returns a view, from above and one side, that shows everything that these frames cover, in pictures of that size.
/// The feature size is that of the first frame. Needs at least one frame.
StrokeView view_of_frames(const Animation& animation, std::span<const FrameRef> frames, int width, int height);

}  // namespace exemplar
