#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"
#include "host/mesh/mesh.h"

namespace exemplar::python {

/// An animation in Python. It never changes; the frames of all clips are numbered one after the other.
struct AnimationObject {
    explicit AnimationObject(Animation of) : animation(std::move(of)) {
        if (animation.frame_count() > 0) frames = select_frames(animation, {});
    }
    const Animation animation;
    std::vector<FrameRef> frames;  ///< of all clips
};
using AnimationPointer = std::shared_ptr<AnimationObject>;

/// Returns the frame of that number; throws UsageError if there is none.
FrameRef frame_of(const AnimationObject& animation, std::int64_t frame);

}  // namespace exemplar::python
