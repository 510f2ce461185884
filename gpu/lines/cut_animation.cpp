#include "gpu/lines/cut_animation.h"

#include <algorithm>
#include <utility>

namespace exemplar {
namespace {

/// Adds the influences of new vertices, which move as those they were cut from.
void add_influences(Rig& rig, std::span<const std::uint32_t> added) {
    for (const std::uint32_t source : added) {
        const auto [begin, end] = std::pair(rig.influence_begin[source], rig.influence_begin[source + 1]);
        for (std::uint32_t i = begin; i < end; ++i) rig.influences.push_back(Influence(rig.influences[i]));
        rig.influence_begin.push_back(static_cast<std::uint32_t>(rig.influences.size()));
    }
}

void add_offsets(MorphTarget& target, std::uint32_t first_added, std::span<const std::uint32_t> added) {
    const std::size_t known = target.vertices.size();
    for (std::uint32_t i = 0; i < added.size(); ++i) {
        const auto end = target.vertices.begin() + static_cast<std::ptrdiff_t>(known);
        const auto at = std::lower_bound(target.vertices.begin(), end, added[i]);
        if (at == end || *at != added[i]) continue;
        const Vec3 offset = target.offsets[static_cast<std::size_t>(at - target.vertices.begin())];
        target.vertices.push_back(first_added + i);
        target.offsets.push_back(offset);
    }
}

}  // namespace

CutAnimation::CutAnimation(const Animation& animation, const TriangleMesh& first, float crease_angle, bool cut)
    : joined_faces_(first.faces), neighbors_(build_face_neighbors(first.faces, first.vertices)), first_(first) {
    mark_sharp_edges(first.faces, first.vertices, crease_angle, neighbors_);
    animation_.kind = animation.kind;
    animation_.rest = animation.rest;
    animation_.rig = animation.rig;
    if (!cut) return;
    split_ = split_at_sharp_edges(first.faces, first.vertex_count(), neighbors_);
    const auto vertex_count = static_cast<std::uint32_t>(first.vertex_count());
    const std::span<const std::uint32_t> added = std::span(split_->source).subspan(vertex_count);
    if (added.empty()) {
        split_.reset();
        return;
    }
    for (TriangleMesh* mesh : {&first_, &animation_.rest}) {
        mesh->vertices = split_->positions(mesh->vertices);
        mesh->faces = split_->faces;
    }
    if (!animation.has_rig()) return;
    add_influences(animation_.rig, added);
    for (MorphTarget& target : animation_.rig.targets) add_offsets(target, vertex_count, added);
}

SurfaceShape CutAnimation::shape(const SurfaceShape& shape) {
    if (!split_ || shape.pose) return shape;
    vertices_ = split_->positions(shape.vertices);
    return {{}, vertices_};
}

}  // namespace exemplar
