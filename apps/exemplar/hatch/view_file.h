#pragma once

#include <filesystem>
#include <string>

#include "apps/exemplar/lines/lines_camera.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// How a mesh is seen and lit in a drawing, as the options of 'exemplar hatch' say it.
struct DrawnView {
    CameraArguments camera;
    std::string light;  ///< direction to it, in eye coordinates
};

/// The mesh of a view.
struct DrawnMesh {
    std::string file;      ///< name of its file
    std::string geometry;  ///< a hash of vertices and faces
    std::size_t faces = 0;
};
DrawnMesh drawn_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

/// A view and its mesh as a file tells them: a picture of 'hatch template' (PNG), or the JSON of 'hatch register'.
struct ViewFile {
    DrawnView view;
    DrawnMesh mesh;
    std::string sheet;    ///< of a sheet to print: the name of its paper (see drawing_sheet); else empty
    std::string drawing;  ///< of a registered view: name of the drawing that shows exactly this view; else empty
};
/// The keyword of the JSON in a PNG.
constexpr const char* k_view_keyword = "Exemplar view";
/// Returns the JSON of a view. Numbers keep their value.
std::string view_file_text(const ViewFile& file);
/// Reads a view. Throws DataError naming the file if it tells none.
ViewFile read_view_file(const std::filesystem::path& path);
/// Throws DataError if a view read from `path` is of another mesh.
void require_mesh_of_view(const std::filesystem::path& path, const DrawnMesh& expected, const DrawnMesh& given);

}  // namespace exemplar
