#include "host/curvature/model/model.h"

#include <fmt/format.h>
#include <xxhash.h>

#include "host/core/errors.h"
#include "host/mesh/io/io_text.h"

namespace exemplar {

std::uint64_t topology_hash(std::span<const Face> faces, std::size_t vertex_count) {
    return XXH3_64bits_withSeed(faces.data(), faces.size_bytes(), vertex_count);
}

void require_compatible(const CurvatureModel& model, const Animation& animation) {
    const auto refuse = [&](const std::string& why) {
        throw ModelError(fmt::format("the model does not fit {}: {}; train one for it", animation.name, why));
    };
    if (model.kind != animation.kind)
        refuse(fmt::format("it was learned on another kind of animation ({}, here {})", name_of(model.kind),
                           name_of(animation.kind)));
    if (model.vertex_count != animation.rest.vertex_count() ||
        model.topology != topology_hash(animation.rest.faces, animation.rest.vertex_count()))
        refuse(fmt::format("it was learned on other triangles ({} vertices, here {})", model.vertex_count,
                           animation.rest.vertex_count()));
    const std::span<const std::uint32_t> parts = model.state.parts_of_rig();
    for (std::size_t c = 0; c < parts.size(); ++c) {
        const std::uint32_t index = parts[c];
        const bool skeleton = model.kind == AnimationKind::skeleton;
        const std::size_t count = skeleton ? animation.rig.nodes.size() : animation.rig.targets.size();
        const std::string& name = model.state.controls[c].name;
        if (index >= count || name != (skeleton ? animation.rig.nodes[index].name : animation.rig.targets[index].name))
            refuse(
                fmt::format("it has no {} {} in that place", skeleton ? "joint" : "blend shape", mesh_io::quote(name)));
    }
    for (const Influence& influence : model.segments.influences)
        if (influence.bone >= animation.rig.bones.size()) refuse("it has fewer bones");
}

}  // namespace exemplar
