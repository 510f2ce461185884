#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "host/animation/write_animation.h"
#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/text.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

/// Returns a folder name made from a clip's name.
std::string folder_name(const std::string& clip) {
    std::string name = clip;
    for (char& c : name)
        if (c == '/' || c == '\\' || (c >= 0 && c < ' ')) c = '_';
    return name.find_first_not_of(". ") == std::string::npos ? "clip" : name;
}

void require_no_meshes(const fs::path& folder) {
    std::error_code ignored;
    const auto known = mesh_extensions();
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        if (std::ranges::find(known, lower_case(entry.path().extension().string())) != known.end())
            throw DataError(fmt::format("{}: holds {} already; write to an empty folder", folder.string(),
                                        entry.path().filename().string()));
}

TriangleMesh rest_shape(const Animation& animation) {
    TriangleMesh shape = animation.rest;
    if (animation.kind != AnimationKind::sequence)
        pose_vertices(animation.rig, animation.rest.vertices, rest_pose(animation.rig), shape.vertices);
    return shape;
}

void write_clip(const fs::path& folder, const Animation& animation, const Clip& clip) {
    require_no_meshes(folder);
    const std::size_t digits = std::max<std::size_t>(4, fmt::formatted_size("{}", clip.size() - 1));
    write_ply(folder / "rest.ply", rest_shape(animation));
    parallel_for(clip.size(), [&](std::size_t i) {
        TriangleMesh frame = animation.rest;
        frame.vertices = frame_vertices(animation, clip, i);
        write_ply(folder / fmt::format("{:0{}}.ply", i, digits), frame);
    });
}

}  // namespace

void write_sequence(const fs::path& folder, const Animation& animation) {
    if (std::ranges::any_of(animation.clips, [](const Clip& clip) { return clip.size() == 0; }) ||
        animation.clips.empty())
        throw UsageError(folder.string() + ": an animation without frames cannot be written");
    if (animation.clips.size() == 1) return write_clip(folder, animation, animation.clips.front());
    std::set<std::string> names;
    for (const Clip& clip : animation.clips) {
        std::string name = folder_name(clip.name);
        for (int i = 2; !names.insert(name).second; ++i) name = fmt::format("{} ({})", folder_name(clip.name), i);
        write_clip(folder / name, animation, clip);
    }
}

}  // namespace exemplar
