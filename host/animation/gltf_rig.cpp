#include "host/animation/gltf_rig.h"

#include <tiny_gltf.h>

#include <set>

#include "host/animation/gltf_nodes.h"

namespace exemplar::animation_io {
namespace {

/// Exporters leave smaller weights than this on joints that move nothing.
constexpr float k_used_weight = 1e-3f;

/// Returns for each node of the file whether a bone depends on it.
std::vector<bool> nodes_of_bones(const mesh_io::GltfSurface& surface) {
    std::vector<bool> needed(surface.world.size(), false);
    for (const Bone& bone : surface.skin.bones)
        for (std::uint32_t node = bone.node; node != k_invalid_index && !needed[node]; node = surface.tree.parent[node])
            needed[node] = true;
    return needed;
}

}  // namespace

Rig rig_of_surface(const mesh_io::GltfReader& gltf, const mesh_io::GltfSurface& surface,
                   std::vector<std::uint32_t>& rig_node, std::vector<std::string>& warnings) {
    Rig rig{surface.skin, {}};
    const std::vector<bool> needed = nodes_of_bones(surface);
    rig_node.assign(needed.size(), k_invalid_index);
    for (const std::uint32_t node : surface.tree.order) {
        if (!needed[node]) continue;
        rig_node[node] = static_cast<std::uint32_t>(rig.nodes.size());
        const std::uint32_t parent = surface.tree.parent[node];
        rig.nodes.push_back({.name = gltf.model().nodes[node].name,
                             .parent = parent == k_invalid_index ? k_invalid_index : rig_node[parent],
                             .rest = read_gltf_transform(gltf, static_cast<int>(node), warnings)});
    }
    for (Bone& bone : rig.bones) bone.node = rig_node[bone.node];
    return rig;
}

AnimationKind gltf_kind(const mesh_io::GltfReader& gltf, const mesh_io::GltfSurface& surface, const Rig& rig) {
    if (gltf.model().asset.generator == k_blend_shapes_generator && !rig.targets.empty())
        return AnimationKind::blend_shapes;
    std::vector<bool> is_used(rig.bones.size(), false);
    for (const Influence& influence : rig.influences)
        if (influence.weight > k_used_weight) is_used[influence.bone] = true;
    for (const std::vector<std::uint32_t>& bones : surface.bones_of_skin) {
        std::set<std::uint32_t> used;
        for (const std::uint32_t bone : bones)
            if (is_used[bone]) used.insert(bone);
        if (used.size() >= 2) return AnimationKind::skeleton;
    }
    return rig.targets.empty() ? AnimationKind::sequence : AnimationKind::blend_shapes;
}

}  // namespace exemplar::animation_io
