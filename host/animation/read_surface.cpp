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

}  // namespace

SurfaceFile read_surface(const fs::path& path, const ReadAnimationOptions& options) {
    std::error_code ignored;  // for names that the system refuses there is no file
    if (!fs::exists(path, ignored))
        throw DataError(fmt::format("{}: no such file or folder{}", path.string(), suggest_file(path)));
    const bool is_folder = fs::is_directory(path, ignored);
    const std::string extension = lower_case(path.extension().string());
    if (!is_folder && extension != ".glb" && extension != ".gltf") return read_still(path);
    try {
        return {read_animation(path, options), {}, {}};
    } catch (const MeshError& error) {
        if (is_folder) throw;
        // If the file holds neither an animation nor a mesh, reading it as a mesh says what is wrong.
        SurfaceFile still = read_still(path);
        still.why_still = error.what();
        return still;
    }
}

}  // namespace exemplar
