#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// How far augmented poses go beyond the frames they are made of.
struct PoseSpread {
    double least_stretch = 0.6, most_stretch = 1.4;  ///< how much of a joint's turn in a frame it makes
    double stray = 0.105;                            ///< deviation of its turn about a random axis, in radians
};
/// For maps that are linear in the shape of the surface: they gain from any bend, where polynomials of angles that
/// follow far ones lose the near.
constexpr PoseSpread k_wide_spread{0.6, 1.6, 0.3};

/// Poses of a rig that no clip has, but that are made of what the given frames have: each joint turns as it does in
/// some frame of its own, somewhat more or less and a little astray; each blend shape has the weight of some frame, now
/// and then any. In a clip joints move together, and what one of them does to the surface cannot be told from what
/// another does; here they move apart, and joints that a clip holds still move, too. The rig poses the surface, so the
/// curvature of such poses can be measured like any other.
Clip augmented_poses(const Animation& animation, std::span<const FrameRef> frames, std::size_t count,
                     std::uint64_t seed, const PoseSpread& spread = {});

}  // namespace exemplar
