#pragma once

#include <vector>

#include "host/hatching/registration/view_pose.h"

namespace exemplar {

/// A point of an object that is to lie on a line of the drawing.
struct LineMatch {
    Vec3d point;   ///< of the object
    Vec2d normal;  ///< unit, across the line
    double gap;    ///< how far the point has to move along the normal, pixels
};

/// Returns the change of a pose that moves points onto their lines as well as it can: one step of iteratively
/// reweighted least squares. Gaps larger than `scale` pixels count less and less (Cauchy's weights). The distance,
/// which outlines hardly tell, is held to about four radii by a weak prior. Steps are bounded to a twentieth of a turn.
PoseChange fitting_change(const ViewPose& pose, const PoseFrame& frame, const std::vector<LineMatch>& matches,
                          double scale);

}  // namespace exemplar
