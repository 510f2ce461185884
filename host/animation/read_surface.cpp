#include "host/animation/read_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/io/io.h"
#include "host/mesh/io/io_import.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

SurfaceFile read_still(const fs::path& path) {
    MeshFile file = read_mesh(path);
    DrawableMesh drawable = drawable_mesh(file.mesh, path.string());
    SurfaceFile surface;
    surface.animation.name = path.string();
    surface.animation.rest = std::move(drawable.mesh);
    surface.animation.warnings = std::move(file.warnings);
    std::ranges::move(drawable.warnings, std::back_inserter(surface.animation.warnings));
    surface.labels = std::move(file.labels);
    return surface;
}

/// Reads a file whose animation is at fault as a mesh, and warns of `reason`. If it holds no mesh either, reading it
/// says what is wrong.
SurfaceFile read_still_because(const fs::path& path, const std::string& reason) {
    SurfaceFile still = read_still(path);
    still.why_still = reason;
    const std::string prefix = path.string() + ": ";
    const std::string_view without = std::string_view(reason).substr(reason.starts_with(prefix) ? prefix.size() : 0);
    still.animation.warnings.push_back(
        fmt::format("it is shown as a still, since its animation has a fault: {}", without));
    return still;
}

}  // namespace

SurfaceFile read_surface(const fs::path& path, const ReadAnimationOptions& options) {
    std::error_code ignored;  // for names that the system refuses there is no file
    if (!fs::exists(path, ignored))
        throw DataError(fmt::format("{}: no such file or folder{}", path.string(), suggest_file(path)));
    const bool is_folder = fs::is_directory(path, ignored);
    const std::string extension = lower_case(path.extension().string());
    if (!is_folder && extension != ".glb" && extension != ".gltf" && !mesh_io::is_imported(extension))
        return read_still(path);
    try {
        return {read_animation(path, options), {}, {}};
    } catch (const NoMotionError& error) {
        SurfaceFile still = read_still(path);
        still.why_still = error.what();
        return still;
    } catch (const MeshError& error) {
        if (is_folder) throw;
        return read_still_because(path, error.what());
    }
}

}  // namespace exemplar
