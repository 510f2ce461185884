#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "apps/exemplar/lines/lines_source.h"
#include "host/lines/strokes/strokes.h"

namespace exemplar {

/// Where a drawing is seen from, as words on the command line.
struct CameraArguments {
    std::string view = "three-quarter";
    std::string eye, target, up = "0,1,0", size = "1000x800";
    double field_of_view = 23;  ///< degrees, vertical; 0: parallel
};

void add_camera_options(CLI::App& command, CameraArguments& arguments);
/// Three numbers separated by commas; throws UsageError naming the option.
Vec3 point_of(const std::string& text, const char* option);
/// Checks all words before any work: throws UsageError naming the option.
void require_camera(const CameraArguments& arguments);
/// A camera and the size of its picture.
struct SizedCamera {
    Camera camera;
    int width = 0, height = 0;
};
/// The camera that shows all vertices of a mesh.
SizedCamera camera_of(const CameraArguments& arguments, const TriangleMesh& extent);
/// The view of all frames: the same camera, which shows the surface in each. Widths of strokes are those of the style
/// at the depth of its center.
StrokeView view_of(const CameraArguments& arguments, LinesSource& source);

}  // namespace exemplar
