#pragma once

#include <string>
#include <vector>

#include "apps/exemplar/lines/lines_source.h"
#include "apps/help/command.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// Command-line arguments of the camera.
struct CameraArguments {
    std::string view = "three-quarter";
    std::string eye, target, up = "0,1,0", shift = "0,0", size = "1000x800";
    double field_of_view = 23;  ///< degrees, vertical; 0: parallel
};

/// Adds and returns the options.
std::vector<Option*> add_camera_options(Command& command, CameraArguments& arguments);
/// Parses three numbers separated by commas; throws UsageError naming the option.
Vec3 point_of(const std::string& text, const char* option);
/// Checks all arguments before any work; throws UsageError naming the option.
void require_camera(const CameraArguments& arguments);
/// A camera and the size of its picture.
struct SizedCamera {
    Camera camera;
    int width = 0, height = 0;
};
/// Returns the camera that shows all vertices of a mesh.
SizedCamera camera_of(const CameraArguments& arguments, const TriangleMesh& extent);
/// Returns the view of all frames: one camera that shows the surface in each. At the depth of the surface's center,
/// strokes have the widths of their style.
StrokeView view_of(const CameraArguments& arguments, LinesSource& source);

}  // namespace exemplar
