#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "host/animation/animation.h"

namespace exemplar {

struct AnimationOptions {
    std::size_t vertices = 5000;    ///< approximate number of vertices; 500 to 100,000
    std::size_t frames = 120;       ///< length of the one clip at 30 per second; 1 to 100,000
    std::uint64_t shape_seed = 1;   ///< the surface: its vertices, faces, skinning weights or blend shapes
    std::uint64_t motion_seed = 1;  ///< the motion, and nothing else
};

/// Returns the kinds of animations that make_animation knows: "figure" (a skinned person), "flag", "curtain",
/// "drape" (simulated cloth, as mesh sequences) and "face" (blend shapes).
std::span<const std::string_view> synth_animation_kinds();

/// Generates an animation of one clip, "motion_<motion seed>": the same kind and options give the same bytes on one
/// build of the program. y is up, shapes face +z; a figure is about 1.75 high, cloth and faces about 1 to 2. Surfaces
/// of figures and faces are closed, manifold and oriented outward; a cloth is a sheet, seen from its front. Throws
/// UsageError for an unknown kind, and for counts out of range.
Animation make_animation(std::string_view kind, const AnimationOptions& options = {});

}  // namespace exemplar
