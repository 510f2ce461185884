#pragma once

#include "host/hatching/registration/drawn_lines.h"

namespace exemplar {

/// A pose, and how well the object's outlines lie on the drawing's lines.
struct OutlineFit {
    ViewPose pose;
    double residual =
        0;  ///< pixels: RMS distance from the object's outer outline to the drawn one, where it is below 3
    double explained = 0;   ///< share of the object's outer outline that matches: within a fiftieth of its size
    bool outlined = false;  ///< whether the drawing has an outline; else the border of its hatching was taken for one
    double cost = 1;  ///< mean robust squared distance of all outlines, both ways; 0 if all lie on lines, 1 if none
};

/// Fits a pose so that the object's outlines, outer and inner, lie on the lines of the drawing, by iterated least
/// squares that match points across the outline, nearer and nearer ones. `size`: longer side of the object, pixels.
OutlineFit fit_to_lines(const TriangleMesh& mesh, const PoseFrame& frame, const ViewPose& start,
                        const DrawnLines& lines, float size);

}  // namespace exemplar
