#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/imaging/camera.h"
#include "host/lines/strokes/strokes.h"
#include "host/mesh/mesh.h"

namespace exemplar {

constexpr int k_max_picture_size = 16384;  ///< maximum width and height of a drawing, in pixels

/// The viewpoint of a drawing as a user specifies it.
struct ViewPoint {
    std::string view = "three-quarter";  ///< one of view_names(), fitted to the picture; ignored with an eye
    std::optional<Vec3> eye, target;     ///< mesh units; the default target is the center of the bounding box
    Vec3 up = Vec3::UnitY();
    double field_of_view = 23;  ///< degrees, vertical; 0: parallel
    Vec2 shift = Vec2::Zero();  ///< where the axis meets the picture: from its middle to the right and up, in heights
    int width = 1000, height = 800;  ///< pixels
};

/// Returns "front", "three-quarter" and so on.
std::vector<std::string> view_names();
/// Returns the direction to the eye of a named view, where y is up and z points to the front; none for another name.
std::optional<Vec3> view_direction(std::string_view name);

/// Returns the camera at the eye or, without an eye, one that shows all vertices of `extent`. A parallel camera with
/// an eye shows as much at the target as one with a field of view of 23 degrees. The name of the view and the
/// direction of `up` must be valid. Throws UsageError if eye and target are the same point.
Camera camera_at(const ViewPoint& point, const TriangleMesh& extent);
/// Returns the view for make_strokes: strokes have the widths of the style at the depth of the center of `extent`.
StrokeView stroke_view(const ViewPoint& point, const TriangleMesh& extent, float feature_size);

}  // namespace exemplar
