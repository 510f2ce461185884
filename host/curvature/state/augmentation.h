#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "host/animation/animation.h"
#include "host/curvature/state/samples.h"

namespace exemplar {

/// How far augmented poses deviate from the frames they are made from.
struct PoseSpread {
    double min_stretch = 0.6, max_stretch = 1.4;  ///< range of the factor on a joint's rotation angle
    double perturbation = 0.105;                  ///< standard deviation of an added random rotation, in radians
};
/// For maps that are linear in the shape of the surface, which gain from any bend. Polynomials of angles would fit
/// these far poses at the expense of near ones.
constexpr PoseSpread k_wide_spread{0.6, 1.6, 0.3};

/// Returns a clip of `count` random poses of a rig that recombine the given frames. Each joint takes its rotation
/// from a frame of its own, scaled and perturbed as `spread` says; each blend shape takes the weight of a random
/// frame or, rarely, any weight in [0, 1]. In clips joints move together, so their effects on the surface cannot be
/// told apart; here they move independently, including joints that a clip holds still. The curvature of such poses
/// is measured like that of any other.
Clip augmented_poses(const Animation& animation, std::span<const FrameRef> frames, std::size_t count,
                     std::uint64_t seed, const PoseSpread& spread = {});

}  // namespace exemplar
