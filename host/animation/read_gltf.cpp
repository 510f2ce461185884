#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "host/animation/gltf_clips.h"
#include "host/animation/gltf_rig.h"
#include "host/animation/read_formats.h"
#include "host/animation/weld_rig.h"
#include "host/mesh/gltf/gltf_file.h"
#include "host/mesh/io/io_origin.h"

namespace exemplar::animation_io {
namespace {

/// Returns whether two morph targets have the same weight at rest and in every frame.
bool weights_agree(const Animation& animation, std::uint32_t a, std::uint32_t b) {
    if (animation.rig.targets[a].rest_weight != animation.rig.targets[b].rest_weight) return false;
    for (const Clip& clip : animation.clips)
        for (const Pose& pose : clip.poses)
            if (pose.weights[a] != pose.weights[b]) return false;
    return true;
}

/// Returns for each morph target the first one of its name that always has the same weight, else itself. A head that
/// is cut into meshes (skin, lashes, teeth) has each target once per mesh.
std::vector<std::uint32_t> equal_targets(const Animation& animation, const mesh_io::GltfSurface& surface) {
    std::map<std::string, std::vector<std::uint32_t>> firsts;
    std::vector<std::uint32_t> first(animation.rig.targets.size());
    for (std::uint32_t t = 0; t < first.size(); ++t) {
        first[t] = t;
        if (!surface.target_is_named[t]) continue;
        std::vector<std::uint32_t>& same_name = firsts[animation.rig.targets[t].name];
        const auto other = std::ranges::find_if(same_name, [&](std::uint32_t f) {
            return surface.target_node[f] != surface.target_node[t] && weights_agree(animation, f, t);
        });
        if (other == same_name.end())
            same_name.push_back(t);
        else
            first[t] = *other;
    }
    return first;
}

/// Appends the offsets of another target; vertices of later meshes have larger numbers.
void append(MorphTarget& target, const MorphTarget& more) {
    target.vertices.insert(target.vertices.end(), more.vertices.begin(), more.vertices.end());
    target.offsets.insert(target.offsets.end(), more.offsets.begin(), more.offsets.end());
}

void merge_targets(Animation& animation, const mesh_io::GltfSurface& surface) {
    const std::vector<std::uint32_t> first = equal_targets(animation, surface);
    std::vector<MorphTarget>& targets = animation.rig.targets;
    std::vector<MorphTarget> kept;
    std::vector<std::uint32_t> kept_column, place(first.size());
    for (std::uint32_t t = 0; t < first.size(); ++t) {
        if (first[t] != t) {
            append(kept[place[first[t]]], targets[t]);
            continue;
        }
        place[t] = static_cast<std::uint32_t>(kept.size());
        kept.push_back(std::move(targets[t]));
        kept_column.push_back(t);
    }
    targets = std::move(kept);
    for (Clip& clip : animation.clips)
        for (Pose& pose : clip.poses) {
            std::vector<float> weights;
            weights.reserve(kept_column.size());
            for (const std::uint32_t column : kept_column) weights.push_back(pose.weights[column]);
            pose.weights = std::move(weights);
        }
}

void make_names_unique(std::vector<MorphTarget>& targets) {
    std::set<std::string> names;
    for (MorphTarget& target : targets) {
        std::string name = target.name;
        for (int i = 2; !names.insert(name).second; ++i) name = fmt::format("{} ({})", target.name, i);
        target.name = name;
    }
}

/// Throws the reason why a surface without skin and morph targets does not move.
[[noreturn]] void fail_still(const mesh_io::GltfReader& gltf, const std::string& name) {
    const std::string lacks = "there is neither a skin of several joints nor a morph target";
    if (gltf.model().animations.empty())
        throw NoMotionError(
            fmt::format("{}: {}; export with the armature or shape keys, or animate nodes", name, lacks));
    gltf.fail(fmt::format("{}, and none of its {} animations moves a node of the surface", lacks,
                          gltf.model().animations.size()));
}

/// Throws if the frames of a sequence take far more memory than the file, or 4 GiB.
void check_frame_bytes(const mesh_io::GltfReader& gltf, const Animation& animation) {
    constexpr double k_free_bytes = 64 << 20, k_bytes_per_byte = 1024, k_most_bytes = 4.0 * (1 << 30);
    const double most = std::min(k_free_bytes + k_bytes_per_byte * static_cast<double>(gltf.bytes()), k_most_bytes);
    const std::size_t frames = animation.frame_count(), vertices = animation.rest.vertex_count();
    if (static_cast<double>(frames) * static_cast<double>(vertices * sizeof(Vec3)) > most)
        gltf.fail(
            fmt::format("the {} frames of {} vertices take more than {:.0f} MB; read fewer frames per second, or "
                        "simplify the meshes",
                        frames, vertices, most / (1 << 20)));
}

/// Replaces the rig, whose nodes carry whole meshes, by the positions of the vertices in each frame.
void bake(const mesh_io::GltfReader& gltf, Animation& animation) {
    if (animation.clips.empty()) fail_still(gltf, animation.name);
    check_frame_bytes(gltf, animation);
    const auto posed = [&](const Pose& pose) {
        std::vector<Vec3> vertices;
        pose_vertices(animation.rig, animation.rest.vertices, pose, vertices);
        return vertices;
    };
    std::vector<std::vector<Vec3>> frames;
    for (const Clip& clip : animation.clips)
        for (const Pose& pose : clip.poses) frames.push_back(posed(pose));
    if (std::ranges::all_of(frames, [&](const auto& frame) { return frame == frames.front(); }))
        fail_still(gltf, animation.name);
    animation.rest.vertices = posed(rest_pose(animation.rig));
    animation.rig = {};
    const std::vector<std::uint32_t> welded_before = animation.vertex_of_source;
    weld_shapes(animation, frames);
    const std::vector<std::uint32_t> welded_now = std::exchange(animation.vertex_of_source, {});
    for (const std::uint32_t v : welded_before) animation.vertex_of_source.push_back(welded_now[v]);
    auto frame = frames.begin();
    for (Clip& clip : animation.clips) {
        const auto end = frame + static_cast<std::ptrdiff_t>(clip.poses.size());
        clip.frames.assign(std::move_iterator(frame), std::move_iterator(end));
        clip.poses.clear();
        frame = end;
    }
}

}  // namespace

Animation read_gltf(std::string_view content, const std::string& name, const std::filesystem::path& folder,
                    const ReadAnimationOptions& options) {
    const tinygltf::Model model = mesh_io::load_gltf(content, name, folder, mesh_io::GltfContent::animation);
    mesh_io::GltfReader gltf(model, name);
    mesh_io::GltfSurface surface = mesh_io::read_gltf_surface(gltf, name);
    Animation animation;
    animation.name = name;
    animation.rest.vertices = std::move(surface.vertices);
    animation.rest.faces = std::move(surface.faces);
    animation.warnings = std::move(surface.warnings);
    GltfLinks links{{}, surface.targets};
    animation.rig = rig_of_surface(gltf, surface, links.rig_node, animation.warnings);
    animation.clips = read_gltf_clips(gltf, links, options, animation);
    merge_targets(animation, surface);
    make_names_unique(animation.rig.targets);
    weld_rig(animation);
    animation.kind = gltf_kind(gltf, surface, animation.rig);
    if (animation.kind == AnimationKind::sequence) bake(gltf, animation);
    animation.rest.source_face_count = static_cast<std::uint32_t>(animation.rest.face_count());
    if (std::string far = mesh_io::far_position_warning(animation.rest); !far.empty())
        animation.warnings.push_back(std::move(far));
    return animation;
}

}  // namespace exemplar::animation_io
