#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/strokes/strokes.h"
#include "host/mesh/mesh.h"

namespace exemplar {

constexpr int k_most_picture_size = 16384;  ///< pixels of a side of a drawing

/// Where a drawing is seen from, in words that a user has: turned into a camera for the surface that it shows.
struct ViewPoint {
    std::string view = "three-quarter";  ///< one of view_names(): from there, as large as it fits; not with an eye
    std::optional<Vec3> eye, target;     ///< mesh units; without a target the eye looks at the middle
    Vec3 up = Vec3::UnitY();
    double field_of_view = 23;       ///< degrees, vertical; 0: parallel
    int width = 1000, height = 800;  ///< pixels
};

/// "front", "three-quarter" and so on.
std::vector<std::string> view_names();
/// The direction to the eye of a named view, where y is up and z comes to the front; none for another name.
std::optional<Vec3> view_direction(std::string_view name);

/// The camera that shows all vertices of `extent`, or stands at the eye: parallel, it then shows as much at the target
/// as one of 23 degrees would. The name of the view and the direction of `up` must be valid. Throws UsageError if eye
/// and target are the same point.
Camera camera_at(const ViewPoint& point, const TriangleMesh& extent);
/// What strokes are drawn with in that view: their widths are those of the style at the depth of the extent's center.
StrokeView stroke_view(const ViewPoint& point, const TriangleMesh& extent, float feature_size);

}  // namespace exemplar
