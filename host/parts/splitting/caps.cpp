#include "host/parts/splitting/caps.h"

#include <algorithm>
#include <unordered_set>

#include "host/core/interrupt.h"
#include "host/parts/splitting/loop_triangulation.h"

namespace exemplar {
namespace {

std::uint64_t undirected_key(std::uint64_t a, std::uint64_t b) {
    return std::min(a, b) << 32 | std::max(a, b);
}

/// Makes caps one after the other and remembers the edges that exist.
class CapMaker {
  public:
    CapMaker(const TriangleMesh& mesh, std::span<const std::uint32_t> twin)
        : mesh_(mesh), twin_(twin), normals_(face_normals(mesh)) {
        used_.reserve(3 * mesh.face_count());
        for (const Face& face : mesh.faces)
            for (std::size_t i = 0; i < 3; ++i) used_.insert(undirected_key(face[i], face[(i + 1) % 3]));
    }

    void add(const CutLoop& loop, std::uint32_t base_part) {
        Cap cap{loop.half_edges, {}, {}, loop.part, base_part};
        std::vector<std::uint32_t> vertices;
        vertices.reserve(loop.half_edges.size());
        for (const std::uint32_t h : loop.half_edges) vertices.push_back(half_edge_start(mesh_, h));
        if (!add_triangulation(vertices, cap)) add_fan(vertices, cap);
        caps_.caps.push_back(std::move(cap));
    }
    Caps take() { return std::move(caps_); }

  private:
    bool add_triangulation(const std::vector<std::uint32_t>& vertices, Cap& cap) {
        if (vertices.size() == 3 && is_on_face(vertices, cap)) return false;
        std::vector<Vec3> points;
        points.reserve(vertices.size());
        for (const std::uint32_t v : vertices) points.push_back(mesh_.vertices[v]);
        const auto found =
            triangulate_loop(points, inward_directions(cap.boundary), [&](std::uint32_t i, std::uint32_t j) {
                return !used_.contains(undirected_key(vertices[i], vertices[j]));
            });
        if (!found) return false;
        const auto count = static_cast<std::uint32_t>(vertices.size());
        cap.boundary_side.assign(count, k_invalid_index);
        cap.faces.reserve(found->size());
        for (const auto& [a, b, c] : *found) add_reversed({a, b, c}, vertices, count, cap);
        return true;
    }

    /// The directions into the solid at the edges of a loop: against the normals of the faces on both sides.
    std::vector<Vec3> inward_directions(const std::vector<std::uint32_t>& half_edges) const {
        std::vector<Vec3> inward;
        inward.reserve(half_edges.size());
        for (const std::uint32_t h : half_edges) {
            const Vec3 sum = normals_[face_of_half_edge(h)] + normals_[face_of_half_edge(twin_[h])];
            inward.push_back(sum.norm() > 0 ? Vec3(-sum.normalized()) : Vec3(Vec3::Zero()));
        }
        return inward;
    }

    /// Adds a triangle of loop places in reverse order, since caps face out of their part.
    void add_reversed(const Face& places, const std::vector<std::uint32_t>& vertices, std::uint32_t count, Cap& cap) {
        const Face reversed{places[0], places[2], places[1]};
        for (std::uint32_t i = 0; i < 3; ++i) {
            const std::uint32_t from = reversed[i], to = reversed[(i + 1) % 3];
            used_.insert(undirected_key(vertices[from], vertices[to]));
            if ((to + 1) % count == from) cap.boundary_side[to] = 3 * static_cast<std::uint32_t>(cap.faces.size()) + i;
        }
        cap.faces.push_back({vertices[reversed[0]], vertices[reversed[1]], vertices[reversed[2]]});
    }

    /// Returns whether a face on either side of a loop of three edges has just these, so that a triangle would lie on
    /// it.
    bool is_on_face(const std::vector<std::uint32_t>& vertices, const Cap& cap) const {
        for (const std::uint32_t h : cap.boundary)
            for (const std::uint32_t side : {h, twin_[h]})
                if (std::ranges::find(vertices, half_edge_end(mesh_, next_half_edge(side))) != vertices.end())
                    return true;
        return false;
    }

    /// Joins all edges of the loop to a new vertex in their middle.
    void add_fan(const std::vector<std::uint32_t>& vertices, Cap& cap) {
        Vec3d sum = Vec3d::Zero();
        for (const std::uint32_t v : vertices) sum += mesh_.vertices[v].cast<double>();
        const auto center = static_cast<std::uint32_t>(mesh_.vertex_count() + caps_.centers.size());
        caps_.centers.push_back((sum / static_cast<double>(vertices.size())).cast<float>());
        const auto count = static_cast<std::uint32_t>(vertices.size());
        cap.faces.clear();
        cap.boundary_side.clear();
        cap.faces.reserve(count);
        cap.boundary_side.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            cap.boundary_side.push_back(3 * i);
            cap.faces.push_back({vertices[(i + 1) % count], vertices[i], center});
        }
    }

    const TriangleMesh& mesh_;
    std::span<const std::uint32_t> twin_;
    std::vector<Vec3> normals_;               ///< per face
    std::unordered_set<std::uint64_t> used_;  ///< edges of the mesh and of caps
    Caps caps_;
};

}  // namespace

Caps make_caps(const TriangleMesh& mesh, const HalfEdges& edges, std::span<const CutLoopGroup> groups) {
    CapMaker maker(mesh, edges.twin);
    for (const CutLoopGroup& group : groups) {
        check_interrupt();
        const auto base =
            std::ranges::max_element(group, {}, [](const CutLoop& loop) { return loop.half_edges.size(); });
        for (auto loop = group.begin(); loop != group.end(); ++loop)
            if (loop != base) maker.add(*loop, base->part);
    }
    return maker.take();
}

}  // namespace exemplar
