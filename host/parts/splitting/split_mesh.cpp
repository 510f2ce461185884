#include "host/parts/splitting/split_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "host/core/disjoint_sets.h"
#include "host/core/errors.h"
#include "host/parts/splitting/caps.h"

namespace exemplar {
namespace {

/// The triangles of a part with corners in vertices of the original or centers of caps, and which corners are one
/// vertex.
struct PartCorners {
    std::vector<Face> faces;
    std::vector<std::array<std::uint32_t, 2>> joined;  ///< corners, 3 * face + corner
};

/// Makes a mesh whose vertices are the classes of joined corners, in order of their first corner.
TriangleMesh mesh_of_corners(const PartCorners& part, const TriangleMesh& original, std::span<const Vec3> centers) {
    DisjointSets sets(3 * part.faces.size());
    for (const auto& [a, b] : part.joined) sets.join(a, b);
    TriangleMesh mesh;
    mesh.origin = original.origin;
    mesh.faces.resize(part.faces.size());
    std::vector<std::uint32_t> vertex(3 * part.faces.size(), k_invalid_index);
    for (std::uint32_t corner = 0; corner < vertex.size(); ++corner) {
        const std::uint32_t first = sets.find(corner), id = part.faces[corner / 3][corner % 3];
        if (first == corner) {
            vertex[corner] = static_cast<std::uint32_t>(mesh.vertices.size());
            const std::size_t count = original.vertex_count();
            mesh.vertices.push_back(id < count ? original.vertices[id] : centers[id - count]);
        }
        mesh.faces[corner / 3][corner % 3] = vertex[first];
    }
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.face_count());
    return mesh;
}

/// Joins the corners at both ends of two sides that lie on each other in opposite directions.
void join_sides(std::uint32_t a, std::uint32_t b, PartCorners& part) {
    part.joined.push_back({a, next_half_edge(b)});
    part.joined.push_back({next_half_edge(a), b});
}

/// Joins equal vertices at the ends of two sides that lie on each other in any direction.
void join_equal_corners(std::uint32_t a, std::uint32_t b, PartCorners& part) {
    const auto vertex = [&](std::uint32_t corner) { return part.faces[corner / 3][corner % 3]; };
    for (const std::uint32_t i : {a, next_half_edge(a)})
        for (const std::uint32_t j : {b, next_half_edge(b)})
            if (vertex(i) == vertex(j)) part.joined.push_back({i, j});
}

/// Collects the triangles of all parts, mesh and caps, and joins their corners across sides.
class PartCollector {
  public:
    PartCollector(const TriangleMesh& mesh, const HalfEdges& edges, std::span<const std::uint32_t> part_of_face,
                  std::size_t part_count)
        : mesh_(mesh), edges_(edges), part_(part_of_face), corners_(part_count), split_{} {
        split_.parts.resize(part_count);
        local_.reserve(mesh.face_count());
        for (std::uint32_t f = 0; f < mesh.face_count(); ++f) local_.push_back(add_face(part_[f], mesh.faces[f], f));
        join_across_mesh();
    }

    void add_caps(const Caps& caps) {
        side_of_cap_.assign(edges_.twin.size(), k_invalid_index);
        for (const Cap& cap : caps.caps) add_cap(cap);
        for (const Cap& cap : caps.caps) join_mirrored_boundary(cap);
        split_.caps = caps.caps.size();
        split_.cap_centers = caps.centers.size();
    }

    SplitMesh finish(std::span<const Vec3> centers, std::size_t open_edges) {
        for (std::size_t p = 0; p < corners_.size(); ++p)
            split_.parts[p].mesh = mesh_of_corners(corners_[p], mesh_, centers);
        split_.open_edges = open_edges;
        return std::move(split_);
    }

  private:
    std::uint32_t add_face(std::uint32_t part, const Face& face, std::uint32_t original) {
        corners_[part].faces.push_back(face);
        split_.parts[part].face_of.push_back(original);
        if (original == k_invalid_index) ++split_.parts[part].cap_faces;
        return static_cast<std::uint32_t>(corners_[part].faces.size() - 1);
    }
    /// The side of the part's triangles for a half-edge of the mesh.
    std::uint32_t side_of(std::uint32_t half_edge) const {
        return 3 * local_[face_of_half_edge(half_edge)] + half_edge % 3;
    }

    void join_across_mesh() {
        for (std::uint32_t h = 0; h < edges_.twin.size(); ++h) {
            const std::uint32_t t = edges_.twin[h];
            if (t != k_invalid_index && h < t && part_[face_of_half_edge(h)] == part_[face_of_half_edge(t)])
                join_sides(side_of(h), side_of(t), corners_[part_[face_of_half_edge(h)]]);
        }
        for (const auto& [a, b] : edges_.irregular)
            if (part_[face_of_half_edge(a)] == part_[face_of_half_edge(b)])
                join_equal_corners(side_of(a), side_of(b), corners_[part_[face_of_half_edge(a)]]);
    }

    /// Adds a cap to its part, joined to the loop, and its mirror image to the base part.
    void add_cap(const Cap& cap) {
        const std::uint32_t first = add_cap_faces(cap, cap.part, false);
        const std::uint32_t mirrored = add_cap_faces(cap, cap.base_part, true);
        for (std::size_t i = 0; i < cap.boundary.size(); ++i) {
            const std::uint32_t side = cap.boundary_side[i];
            join_sides(3 * first + side, side_of(cap.boundary[i]), corners_[cap.part]);
            side_of_cap_[cap.boundary[i]] = 3 * mirrored + 3 * (side / 3) + 2 - side % 3;
        }
    }
    std::uint32_t add_cap_faces(const Cap& cap, std::uint32_t part, bool mirrored) {
        const auto first = static_cast<std::uint32_t>(corners_[part].faces.size());
        for (const auto& [a, b, c] : cap.faces)
            add_face(part, mirrored ? Face{a, c, b} : Face{a, b, c}, k_invalid_index);
        TriangleMesh sheet;
        sheet.faces.assign(corners_[part].faces.begin() + first, corners_[part].faces.end());
        const HalfEdges inner = build_half_edges(sheet);
        for (std::uint32_t h = 0; h < inner.twin.size(); ++h)
            if (inner.twin[h] != k_invalid_index && h < inner.twin[h])
                join_sides(3 * first + h, 3 * first + inner.twin[h], corners_[part]);
        return first;
    }

    /// Joins the mirror image of a cap to the base part, or to the mirror images of other caps.
    void join_mirrored_boundary(const Cap& cap) {
        for (const std::uint32_t h : cap.boundary) {
            const std::uint32_t t = edges_.twin[h];
            if (side_of_cap_[t] == k_invalid_index)
                join_sides(side_of_cap_[h], side_of(t), corners_[cap.base_part]);
            else if (h < t)
                join_sides(side_of_cap_[h], side_of_cap_[t], corners_[cap.base_part]);
        }
    }

    const TriangleMesh& mesh_;
    const HalfEdges& edges_;
    std::span<const std::uint32_t> part_;
    std::vector<PartCorners> corners_;        ///< per part
    std::vector<std::uint32_t> local_;        ///< per face its number in its part
    std::vector<std::uint32_t> side_of_cap_;  ///< per half-edge the side of the mirrored cap, in the base part
    SplitMesh split_;
};

/// Gives each part the vertices that its faces refer to, in their order.
SplitMesh split_at_vertices(const TriangleMesh& mesh, std::span<const std::uint32_t> part_of_face,
                            std::size_t part_count) {
    SplitMesh split;
    split.parts.resize(part_count);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        PartMesh& part = split.parts[part_of_face[f]];
        part.mesh.faces.push_back(mesh.faces[f]);
        part.face_of.push_back(f);
    }
    std::vector<std::uint32_t> number(mesh.vertex_count(), k_invalid_index);
    for (PartMesh& part : split.parts) {
        std::vector<std::uint32_t> used;
        used.reserve(3 * part.mesh.face_count());
        for (const Face& face : part.mesh.faces) used.insert(used.end(), face.begin(), face.end());
        std::ranges::sort(used);
        used.erase(std::unique(used.begin(), used.end()), used.end());
        part.mesh.vertices.reserve(used.size());
        for (const std::uint32_t v : used) {
            number[v] = static_cast<std::uint32_t>(part.mesh.vertices.size());
            part.mesh.vertices.push_back(mesh.vertices[v]);
        }
        for (Face& face : part.mesh.faces)
            for (std::uint32_t& corner : face) corner = number[corner];
        part.mesh.origin = mesh.origin;
        part.mesh.source_face_count = static_cast<std::uint32_t>(part.mesh.face_count());
    }
    return split;
}

}  // namespace

SplitMesh split_mesh(const TriangleMesh& mesh, std::span<const std::uint32_t> part_of_face, std::size_t part_count,
                     const SplitOptions& options) {
    if (part_of_face.size() != mesh.face_count())
        throw UsageError(fmt::format("{} part numbers for {} faces", part_of_face.size(), mesh.face_count()));
    for (const std::uint32_t part : part_of_face)
        if (part >= part_count) throw UsageError(fmt::format("part {} of {}", part, part_count));
    if (!options.caps) return split_at_vertices(mesh, part_of_face, part_count);
    const HalfEdges edges = build_half_edges(mesh);
    const CutLoops loops = find_cut_loops(mesh, edges, part_of_face);
    const Caps caps = make_caps(mesh, edges, loops.groups);
    PartCollector collector(mesh, edges, part_of_face, part_count);
    collector.add_caps(caps);
    return collector.finish(caps.centers, loops.open_edges);
}

void explode_parts(std::span<PartMesh> parts, double share) {
    BoundingBox whole{Vec3d::Constant(1e300), Vec3d::Constant(-1e300)};
    std::vector<Vec3d> center(parts.size(), Vec3d::Zero());
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (parts[p].mesh.faces.empty()) continue;
        const BoundingBox box = bounding_box(parts[p].mesh);
        center[p] = (box.low + box.high) / 2;
        whole = {whole.low.cwiseMin(box.low), whole.high.cwiseMax(box.high)};
    }
    const Vec3d middle = (whole.low + whole.high) / 2;
    double farthest = 0;
    for (std::size_t p = 0; p < parts.size(); ++p)
        if (!parts[p].mesh.faces.empty()) farthest = std::max(farthest, (center[p] - middle).norm());
    if (!(farthest > 0)) return;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        const Vec3 offset = ((center[p] - middle) / farthest * share * whole.diagonal()).cast<float>();
        for (Vec3& v : parts[p].mesh.vertices) v += offset;
    }
}

}  // namespace exemplar
