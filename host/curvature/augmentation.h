#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "host/animation/animation.h"
#include "host/curvature/samples.h"

namespace exemplar {

/// Poses of a rig that no clip has, but that are made of what the given frames have: each joint turns as it does in
/// some frame of its own, somewhat more or less and a little astray; each blend shape has the weight of some frame, now
/// and then any. In a clip joints move together, and what one of them does to the surface cannot be told from what
/// another does; here they move apart, and joints that a clip holds still move, too. The rig poses the surface, so the
/// curvature of such poses can be measured like any other.
Clip augmented_poses(const Animation& animation, std::span<const FrameRef> frames, std::size_t count,
                     std::uint64_t seed);

}  // namespace exemplar
