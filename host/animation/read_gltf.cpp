#include <fmt/format.h>
#include <tiny_gltf.h>

#include <map>
#include <set>

#include "host/animation/gltf_clips.h"
#include "host/animation/gltf_rig.h"
#include "host/animation/read_formats.h"
#include "host/animation/weld_rig.h"
#include "host/mesh/io/io_gltf_file.h"

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
    animation.rest.source_face_count = static_cast<std::uint32_t>(animation.rest.face_count());
    return animation;
}

}  // namespace exemplar::animation_io
