// Reads folders with a mesh per frame or per blend shape.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "host/animation/check_animation.h"
#include "host/animation/read_formats.h"
#include "host/animation/weld_rig.h"
#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/text.h"
#include "host/mesh/io/io.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::animation_io {
namespace {

namespace fs = std::filesystem;

/// The meshes of a folder.
struct ShapeFiles {
    std::vector<fs::path> frames;  ///< in natural order; the targets of blend shapes
    fs::path rest, neutral;        ///< empty if there is none
};

void set_once(fs::path& place, const fs::path& path) {
    if (!place.empty())
        throw MeshError(fmt::format("{}: {} and {} stand for the same; remove one", path.parent_path().string(),
                                    place.filename().string(), path.filename().string()));
    place = path;
}

/// Returns a file's name up to the number at its end.
std::string before_number(const fs::path& path) {
    std::string stem = path.stem().string();
    while (!stem.empty() && stem.back() >= '0' && stem.back() <= '9') stem.pop_back();
    return stem;
}

/// Turns around frames like walk-1 and walk-2, which natural order puts before walk0, if there are also frames like
/// walk0: the hyphen is then a minus.
void order_negative_numbers(std::vector<fs::path>& frames) {
    std::set<std::string> beginnings;
    for (const fs::path& path : frames) beginnings.insert(before_number(path));
    for (auto first = frames.begin(); first != frames.end();) {
        const std::string beginning = before_number(*first);
        const auto last =
            std::find_if(first, frames.end(), [&](const fs::path& p) { return before_number(p) != beginning; });
        if (beginning.ends_with('-') && beginnings.contains(beginning.substr(0, beginning.size() - 1)))
            std::reverse(first, last);
        first = last;
    }
}

ShapeFiles shape_files(const fs::path& folder) {
    ShapeFiles files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const fs::path& path = entry.path();
        const auto known = mesh_extensions();
        const bool is_mesh = std::ranges::find(known, lower_case(path.extension().string())) != known.end();
        if (!is_mesh || !entry.is_regular_file() || path.filename().string().starts_with('.')) continue;
        const std::string stem = lower_case(path.stem().string());
        if (stem == "rest")
            set_once(files.rest, path);
        else if (stem == "neutral")
            set_once(files.neutral, path);
        else
            files.frames.push_back(path);
    }
    std::ranges::sort(files.frames, natural_less, [](const fs::path& path) { return path.filename().string(); });
    order_negative_numbers(files.frames);
    return files;
}

void check_files(const ShapeFiles& files, const fs::path& folder) {
    if (files.frames.empty())
        throw MeshError(folder.string() + ": the folder holds no meshes to animate; put one file a frame in it");
    const auto extension = [](const fs::path& path) { return lower_case(path.extension().string()); };
    for (const fs::path& path : files.frames)
        if (extension(path) != extension(files.frames.front()))
            throw MeshError(fmt::format("{}: {} and {} are of different formats; keep one kind", folder.string(),
                                        files.frames.front().filename().string(), path.filename().string()));
}

/// Returns the corners of each polygon of a file in increasing order. Polygons are compared instead of triangles
/// because the cut into triangles depends on the shape.
std::vector<std::vector<std::uint32_t>> polygons_of(const TriangleMesh& mesh) {
    std::vector<std::vector<std::uint32_t>> polygons(mesh.source_face_count);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        auto& polygon = polygons[mesh.source_of(f)];
        polygon.insert(polygon.end(), mesh.faces[f].begin(), mesh.faces[f].end());
    }
    for (auto& polygon : polygons) {
        std::ranges::sort(polygon);
        polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    }
    return polygons;
}

/// Describes the difference in topology; empty if there is none.
std::string difference(const TriangleMesh& first, const TriangleMesh& other) {
    if (first.vertex_count() != other.vertex_count())
        return fmt::format("{} vertices instead of {}", other.vertex_count(), first.vertex_count());
    if (first.source_face_count != other.source_face_count)
        return fmt::format("{} faces instead of {}", other.source_face_count, first.source_face_count);
    if (first.faces == other.faces) return {};
    const auto expected = polygons_of(first), found = polygons_of(other);
    for (std::size_t f = 0; f < expected.size(); ++f)
        if (expected[f] != found[f]) return fmt::format("other corners in face {} (from 0)", f);
    return {};
}

/// Returns the vertices of a mesh relative to `origin`, that of the file with which the animation began.
std::vector<Vec3> vertices_from(const Vec3d& origin, TriangleMesh mesh) {
    if (mesh.origin != origin)
        for (Vec3& p : mesh.vertices) p = (p.cast<double>() + (mesh.origin - origin)).cast<float>();
    return std::move(mesh.vertices);
}

/// Reads the vertex positions of each file, which must have the topology of `first` (of file `first_path`). Throws
/// for the first file, in order, with a fault.
std::vector<std::vector<Vec3>> read_shapes(const std::vector<fs::path>& paths, const TriangleMesh& first,
                                           const fs::path& first_path) {
    std::vector<std::vector<Vec3>> shapes(paths.size());
    std::vector<std::string> faults(paths.size());
    parallel_for(paths.size(), [&](std::size_t i) {
        try {
            TriangleMesh mesh = read_mesh(paths[i]).mesh;
            if (const std::string what = difference(first, mesh); !what.empty())
                faults[i] = fmt::format("{}: has {}, unlike {}; all files need one topology", paths[i].string(), what,
                                        first_path.filename().string());
            shapes[i] = vertices_from(first.origin, std::move(mesh));
        } catch (const MeshError& error) {
            faults[i] = error.what();
        }
    });
    for (const std::string& fault : faults)
        if (!fault.empty()) throw MeshError(fault);
    return shapes;
}

/// Starts an animation with the mesh and warnings of the file that the others are compared with.
Animation begin(const fs::path& folder, const fs::path& first) {
    MeshFile file = read_mesh(first);
    Animation animation;
    animation.name = folder.string();
    animation.rest = std::move(file.mesh);
    for (const std::string& warning : file.warnings)
        animation.warnings.push_back(
            fmt::format("{}: {}", mesh_io::printable(first.filename().string(), 100), warning));
    return animation;
}

/// Returns the folder's name, also for "a/b/" and ".".
std::string name_of_folder(const fs::path& folder) {
    std::error_code ignored;
    const fs::path full = fs::weakly_canonical(folder, ignored);
    return full.has_filename() ? full.filename().string() : folder.string();
}

Animation read_sequence(const fs::path& folder, const ShapeFiles& files, const ReadAnimationOptions& options) {
    const fs::path first = files.rest.empty() ? files.frames.front() : files.rest;
    Animation animation = begin(folder, first);
    std::vector<std::vector<Vec3>> frames = read_shapes(files.frames, animation.rest, first);
    if (files.rest.empty())
        if (const auto whole =
                std::ranges::find_if(frames, [](const std::vector<Vec3>& frame) { return is_finite(frame); });
            whole != frames.end())
            animation.rest.vertices = *whole;
    weld_shapes(animation, frames);
    animation.kind = AnimationKind::sequence;
    animation.clips.push_back({.name = name_of_folder(folder),
                               .frames_per_second = options.frames_per_second,
                               .poses = {},
                               .frames = std::move(frames)});
    return animation;
}

MorphTarget target_between(const std::string& name, const std::vector<Vec3>& neutral, const std::vector<Vec3>& shape) {
    MorphTarget target{.name = name, .vertices = {}, .offsets = {}};
    for (std::uint32_t v = 0; v < neutral.size(); ++v) {
        if (shape[v] == neutral[v]) continue;
        target.vertices.push_back(v);
        target.offsets.push_back(shape[v] - neutral[v]);
    }
    return target;
}

Animation read_blend_shapes(const fs::path& folder, const ShapeFiles& files) {
    std::vector<fs::path> paths = files.frames;
    if (!files.rest.empty()) paths.push_back(files.rest);
    Animation animation = begin(folder, files.neutral);
    std::vector<std::vector<Vec3>> shapes = read_shapes(paths, animation.rest, files.neutral);
    weld_shapes(animation, shapes);
    animation.kind = AnimationKind::blend_shapes;
    Rig& rig = animation.rig;
    rig.nodes = {{.name = name_of_folder(folder), .parent = k_invalid_index, .rest = {}}};
    rig.bones = {{}};
    const auto vertex_count = static_cast<std::uint32_t>(animation.rest.vertex_count());
    rig.influences.assign(vertex_count, {0, 1.0f});
    for (std::uint32_t v = 0; v <= vertex_count; ++v) rig.influence_begin.push_back(v);
    for (std::size_t i = 0; i < paths.size(); ++i)
        rig.targets.push_back(target_between(paths[i].stem().string(), animation.rest.vertices, shapes[i]));
    return animation;
}

}  // namespace

Animation read_folder(const fs::path& folder, const ReadAnimationOptions& options) {
    try {
        const ShapeFiles files = shape_files(folder);
        check_files(files, folder);
        return files.neutral.empty() ? read_sequence(folder, files, options) : read_blend_shapes(folder, files);
    } catch (const fs::filesystem_error& error) {
        throw MeshError(fmt::format("{}: cannot be read: {}", folder.string(), error.code().message()));
    }
}

}  // namespace exemplar::animation_io
