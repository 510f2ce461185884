#pragma once

#include "host/hatching/registration/view_pose.h"

namespace exemplar {

/// A light, and how well it explains a picture.
struct LightFit {
    Vec3 direction = Vec3::UnitZ();  ///< unit, to the light, in eye coordinates: right, up, towards the eye
    double correlation = 0;          ///< of the light that falls on each pixel with the picture's brightness
};

/// Finds the direction of a distant light from a picture of a mesh, of the frame's size: its brightness is taken for a
/// constant plus the cosine of Lambert's law where light falls. `smoothing`: pixels, for pictures made of strokes.
LightFit fit_light(const FloatImage& brightness, const TriangleMesh& mesh, const ViewPose& pose, const PoseFrame& frame,
                   float smoothing);

}  // namespace exemplar
