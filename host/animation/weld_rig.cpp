#include "host/animation/weld_rig.h"

#include <algorithm>
#include <unordered_map>

#include "host/mesh/editing/weld.h"

namespace exemplar::animation_io {
namespace {

struct Offset {
    std::uint32_t target;
    Vec3 offset;
    bool operator==(const Offset&) const = default;
};

/// Compressed rows: the morph offsets of each vertex, by increasing target.
struct OffsetRows {
    std::vector<std::uint32_t> begin;
    std::vector<Offset> offsets;

    std::span<const Offset> of(std::size_t v) const {
        return {offsets.data() + begin[v], offsets.data() + begin[v + 1]};
    }
};

OffsetRows offsets_by_vertex(const Rig& rig, std::size_t vertex_count) {
    OffsetRows rows;
    rows.begin.assign(vertex_count + 1, 0);
    for (const MorphTarget& target : rig.targets)
        for (const std::uint32_t v : target.vertices) ++rows.begin[v + 1];
    for (std::size_t v = 0; v < vertex_count; ++v) rows.begin[v + 1] += rows.begin[v];
    rows.offsets.resize(rows.begin.back());
    std::vector<std::uint32_t> next(rows.begin.begin(), rows.begin.end() - 1);
    for (std::uint32_t t = 0; t < rig.targets.size(); ++t)
        for (std::size_t i = 0; i < rig.targets[t].vertices.size(); ++i)
            rows.offsets[next[rig.targets[t].vertices[i]]++] = {t, rig.targets[t].offsets[i]};
    return rows;
}

/// Returns whether no weight differs by more than a step of eight bits.
bool same_influences(std::span<const Influence> a, std::span<const Influence> b) {
    constexpr float k_step = 1.0f / 255 + 1e-6f;
    std::size_t i = 0, j = 0;
    while (i < a.size() || j < b.size()) {
        const std::uint32_t bone_a = i < a.size() ? a[i].bone : k_invalid_index,
                            bone_b = j < b.size() ? b[j].bone : k_invalid_index;
        const float weight_a = bone_a <= bone_b ? a[i].weight : 0, weight_b = bone_b <= bone_a ? b[j].weight : 0;
        if (std::abs(weight_a - weight_b) > k_step) return false;
        i += bone_a <= bone_b;
        j += bone_b <= bone_a;
    }
    return true;
}

/// Returns the group of each vertex, numbered in order of first vertex.
std::vector<std::uint32_t> rig_groups(const Animation& animation) {
    const std::vector<Vec3>& vertices = animation.rest.vertices;
    const OffsetRows rows = offsets_by_vertex(animation.rig, vertices.size());
    VertexWelder welder;
    std::vector<Vec3> places;
    std::vector<std::vector<std::uint32_t>> first_at;  ///< per place the first vertex of each group there
    std::vector<std::uint32_t> groups(vertices.size());
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < vertices.size(); ++v) {
        const std::uint32_t place = welder.add(vertices[v], places);
        if (place == first_at.size()) first_at.emplace_back();
        const auto same = [&](std::uint32_t other) {
            return std::ranges::equal(rows.of(v), rows.of(other)) &&
                   same_influences(animation.rig.influences_of(v), animation.rig.influences_of(other));
        };
        const auto other = std::ranges::find_if(first_at[place], same);
        groups[v] = other == first_at[place].end() ? count++ : groups[*other];
        if (other == first_at[place].end()) first_at[place].push_back(v);
    }
    return groups;
}

void weld_influences(Rig& rig, const std::vector<std::uint32_t>& groups) {
    std::vector<std::uint32_t> begin{0};
    std::vector<Influence> influences;
    for (std::size_t v = 0; v < groups.size(); ++v) {
        if (groups[v] + 1 != begin.size()) continue;
        const std::span<const Influence> row = rig.influences_of(v);
        influences.insert(influences.end(), row.begin(), row.end());
        begin.push_back(static_cast<std::uint32_t>(influences.size()));
    }
    rig.influence_begin = std::move(begin);
    rig.influences = std::move(influences);
}

/// Replaces vertices by groups in a target. Groups increase with their first vertices, and all vertices of a group
/// have the same offset.
void weld_target(MorphTarget& target, const std::vector<std::uint32_t>& groups) {
    MorphTarget welded{.name = target.name, .vertices = {}, .offsets = {}, .rest_weight = target.rest_weight};
    for (std::size_t i = 0; i < target.vertices.size(); ++i) {
        const std::uint32_t group = groups[target.vertices[i]];
        if (!welded.vertices.empty() && group <= welded.vertices.back()) continue;
        welded.vertices.push_back(group);
        welded.offsets.push_back(target.offsets[i]);
    }
    target = std::move(welded);
}

}  // namespace

void weld_rig(Animation& animation) {
    const std::vector<std::uint32_t> groups = rig_groups(animation);
    weld_influences(animation.rig, groups);
    for (MorphTarget& target : animation.rig.targets) weld_target(target, groups);
    animation.rest.vertices = first_of_groups(animation.rest.vertices, groups);
    weld_faces(animation.rest.faces, groups);
    animation.vertex_of_source = groups;
}

std::vector<std::uint32_t> group_inseparable(const std::vector<const std::vector<Vec3>*>& shapes) {
    std::vector<std::uint32_t> groups(shapes.front()->size(), 0);
    std::uint32_t count = 0;
    for (const std::vector<Vec3>* shape : shapes) {
        VertexWelder welder;
        std::vector<Vec3> places;
        std::unordered_map<std::uint64_t, std::uint32_t> finer;
        for (std::size_t v = 0; v < groups.size(); ++v) {
            const std::uint64_t key = std::uint64_t{groups[v]} << 32 | welder.add((*shape)[v], places);
            groups[v] = finer.try_emplace(key, static_cast<std::uint32_t>(finer.size())).first->second;
        }
        count = static_cast<std::uint32_t>(finer.size());
        if (count == groups.size()) break;
    }
    return groups;
}

void weld_faces(std::vector<Face>& faces, const std::vector<std::uint32_t>& groups) {
    for (Face& face : faces)
        for (std::uint32_t& corner : face) corner = groups[corner];
}

void weld_shapes(Animation& animation, std::vector<std::vector<Vec3>>& shapes) {
    std::vector<const std::vector<Vec3>*> all{&animation.rest.vertices};
    for (const std::vector<Vec3>& shape : shapes) all.push_back(&shape);
    animation.vertex_of_source = group_inseparable(all);
    animation.rest.vertices = first_of_groups(animation.rest.vertices, animation.vertex_of_source);
    weld_faces(animation.rest.faces, animation.vertex_of_source);
    for (std::vector<Vec3>& shape : shapes) shape = first_of_groups(shape, animation.vertex_of_source);
}

}  // namespace exemplar::animation_io
