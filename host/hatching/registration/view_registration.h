#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "host/hatching/registration/outline_fit.h"

namespace exemplar {

struct RegistrationOptions {
    std::optional<ViewPose> start;       ///< where to begin, in pixels of the drawing; else all views are searched
    std::function<void()> step = [] {};  ///< called k_registration_steps times
};
constexpr std::size_t k_registration_steps = 110;

/// Finds the camera of a drawing by the outlines in it: the views in which the object covers what is drawn, and among
/// them the one whose outlines, outer and inner, lie on lines of the drawing. Returns at most three views that differ
/// from each other, best first. `darkness` (see drawing_darkness) is of any size; poses are in its pixels. Throws
/// DataError if nothing is drawn.
std::vector<OutlineFit> register_view(const TriangleMesh& mesh, const FloatImage& darkness,
                                      const RegistrationOptions& options = {});

/// Returns the mesh of a frame of an animation.
using FrameMesh = std::function<TriangleMesh(std::size_t frame)>;
/// The frame of an animation that a drawing shows, and its view.
struct RegisteredFrame {
    std::size_t frame = 0;
    OutlineFit fit;
};
constexpr std::size_t k_frame_registration_steps = 19;
/// Finds the frame of an animation of `count` frames that a drawing shows, and its view: searches sixteen frames, and
/// then those around the three best. `step` is called k_frame_registration_steps times. Throws DataError if nothing is
/// drawn, UsageError if there are no frames.
RegisteredFrame register_frame(std::size_t count, const FrameMesh& mesh_of, const FloatImage& darkness,
                               const std::function<void()>& step);

}  // namespace exemplar
