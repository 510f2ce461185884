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

}  // namespace exemplar
