#include "gpu/curvature/surface/vertex_rings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

#include "host/core/errors.h"

namespace exemplar {
namespace {

// The other two corners of a face at a vertex, in the face's order.
struct Wing {
    std::uint32_t from;
    std::uint32_t to;
};

// The wings of all vertices, as compressed rows.
struct Wings {
    std::vector<std::size_t> begin;
    std::vector<Wing> all;
    std::span<Wing> of(std::size_t v) { return {all.data() + begin[v], all.data() + begin[v + 1]}; }
};

bool names_a_vertex_twice(const Face& face) {
    return face[0] == face[1] || face[1] == face[2] || face[2] == face[0];
}

void check_ring_sizes(const TriangleMesh& mesh) {
    if (mesh.vertex_count() > shared::k_ring_vertex)
        throw MeshError(fmt::format("a mesh of {} vertices is over the limit of {}; split or simplify it",
                                    mesh.vertex_count(), shared::k_ring_vertex));
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (const std::uint32_t v : mesh.faces[f])
            if (v >= mesh.vertex_count())
                throw MeshError(fmt::format("face {} refers to vertex {}, but there are {}; remove the face", f, v,
                                            mesh.vertex_count()));
}

Wings wings_of(const TriangleMesh& mesh) {
    Wings wings;
    wings.begin.assign(mesh.vertex_count() + 1, 0);
    for (const Face& face : mesh.faces)
        if (!names_a_vertex_twice(face))
            for (const std::uint32_t v : face) ++wings.begin[v + 1];
    for (std::size_t v = 0; v < mesh.vertex_count(); ++v) wings.begin[v + 1] += wings.begin[v];
    wings.all.resize(wings.begin.back());
    std::vector<std::size_t> next(wings.begin.begin(), wings.begin.end() - 1);
    for (const Face& face : mesh.faces)
        if (!names_a_vertex_twice(face))
            for (std::size_t i = 0; i < 3; ++i) wings.all[next[face[i]]++] = {face[(i + 1) % 3], face[(i + 2) % 3]};
    return wings;
}

// Chains the wings of one vertex into fans, in O(n log n) for n of them.
class FanBuilder {
  public:
    /// Appends the fans of `wings`, which it sorts, to `entries`.
    void append(std::span<Wing> wings, std::vector<std::uint32_t>& entries) {
        std::ranges::stable_sort(wings, {}, &Wing::from);
        ends_.clear();
        for (const Wing& wing : wings) ends_.push_back(wing.to);
        std::ranges::sort(ends_);
        taken_.assign(wings.size(), 0);
        // Open fans begin at a corner where no wing ends. The other wings are closed rings, which begin anywhere.
        for (const Wing& wing : wings)
            if (!std::ranges::binary_search(ends_, wing.from)) append_fan(wings, wing.from, entries);
        for (const Wing& wing : wings) append_fan(wings, wing.from, entries);
    }

  private:
    void append_fan(std::span<const Wing> wings, std::uint32_t corner, std::vector<std::uint32_t>& entries) {
        std::uint32_t mark = shared::k_ring_fan;
        for (const Wing* wing = take(wings, corner); wing; wing = take(wings, corner)) {
            if (mark) entries.push_back(corner | mark);
            mark = 0;
            corner = wing->to;
            entries.push_back(corner);
        }
    }
    // Returns the next unused wing from `corner`, or null. There are several only where the surface is not manifold.
    const Wing* take(std::span<const Wing> wings, std::uint32_t corner) {
        const auto first =
            static_cast<std::size_t>(std::ranges::lower_bound(wings, corner, {}, &Wing::from) - wings.begin());
        if (first == wings.size()) return nullptr;
        const std::size_t next = first + taken_[first];
        if (next == wings.size() || wings[next].from != corner) return nullptr;
        ++taken_[first];
        return &wings[next];
    }

    std::vector<std::uint32_t> ends_;
    std::vector<std::size_t> taken_;  // at the first wing from a corner: number of used ones
};

void append_texels(const std::vector<std::uint32_t>& entries, std::vector<shared::uvec4>& texels) {
    for (std::size_t i = 0; i < entries.size(); i += 4) {
        std::array<std::uint32_t, 4> four{};
        for (std::size_t j = 0; j < std::min<std::size_t>(4, entries.size() - i); ++j) four[j] = entries[i + j];
        texels.push_back({four[0], four[1], four[2], four[3]});
    }
}

}  // namespace

VertexRings build_vertex_rings(const TriangleMesh& mesh) {
    check_ring_sizes(mesh);
    Wings wings = wings_of(mesh);
    VertexRings rings;
    rings.begin.reserve(mesh.vertex_count());
    rings.texels.reserve(2 * mesh.vertex_count());
    FanBuilder fans;
    std::vector<std::uint32_t> entries;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        entries.clear();
        fans.append(wings.of(v), entries);
        if (entries.empty()) entries.push_back(v | shared::k_ring_fan);
        entries.back() |= shared::k_ring_last;
        rings.begin.push_back(static_cast<std::uint32_t>(rings.texels.size()));
        append_texels(entries, rings.texels);
    }
    return rings;
}

}  // namespace exemplar
