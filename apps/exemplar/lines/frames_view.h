#pragma once

#include <span>

#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// The view of pictures of that size that shows what all these frames cover, from above and one side. The feature size
/// is that of the first. There must be a frame.
StrokeView view_of_frames(const Animation& animation, std::span<const FrameRef> frames, int width, int height);

}  // namespace exemplar
