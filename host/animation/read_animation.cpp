#include "host/animation/read_animation.h"

#include <fmt/format.h>

#include <cmath>

#include "host/animation/check_animation.h"
#include "host/animation/read_formats.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/core/text.h"
#include "host/mesh/io/io_import.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

std::string read_content(const fs::path& path) {
    try {
        return read_file(path);
    } catch (const DataError& error) {
        throw MeshError(error.what());
    }
}

Animation read_unchecked(const fs::path& path, const ReadAnimationOptions& options) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return animation_io::read_folder(path, options);
    const std::string extension = lower_case(path.extension().string());
    const bool is_gltf = extension == ".gltf" || extension == ".glb", exists = fs::exists(path, ignored);
    if (exists && mesh_io::is_imported(extension))
        return animation_io::animation_of_import(mesh_io::run_import(path, mesh_io::ImportContent::animation),
                                                 path.string(), options);
    if (!is_gltf && exists)
        throw MeshError(path.string() +
                        ": one file is an animation only as glTF (.gltf, .glb), FBX or COLLADA (.dae); name the folder "
                        "that holds the frames");
    return animation_io::read_gltf(read_content(path), path.string(), path.parent_path(), options);
}

}  // namespace

Animation read_animation(const fs::path& path, const ReadAnimationOptions& options) {
    if (!(options.frames_per_second > 0 && std::isfinite(options.frames_per_second)))
        throw UsageError(fmt::format("{} is no rate of frames per second", options.frames_per_second));
    Animation animation = read_unchecked(path, options);
    check_animation(animation);
    return animation;
}

}  // namespace exemplar
