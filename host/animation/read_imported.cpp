// Reads the animations of files that exemplar-import translates to glTF.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "host/animation/read_formats.h"
#include "host/mesh/io/io_import.h"

namespace exemplar::animation_io {

Animation animation_of_import(std::string_view output, const std::string& name, const ReadAnimationOptions& options) {
    std::vector<std::string> warnings = mesh_io::take_import_warnings(output);
    if (output.empty())
        throw NoMotionError(fmt::format(
            "{}: there is neither a skin, a morph target nor an animation; export with the armature or shape keys, or "
            "animate nodes",
            name));
    if (!output.starts_with("glTF")) throw MeshError(name + ": exemplar-import wrote no scene; install it again");
    // The scene has no buffers beside it, and a damaged one finds none in what is no folder.
    Animation animation = read_gltf(output, name, "/dev/null", options);
    animation.warnings.insert(animation.warnings.begin(), std::move_iterator(warnings.begin()),
                              std::move_iterator(warnings.end()));
    return animation;
}

}  // namespace exemplar::animation_io
