#include "host/synth/modeling/edit_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/mesh/topology.h"

namespace exemplar {
namespace {

constexpr std::size_t k_max_valence = 10;
constexpr float k_min_facing = 0.25f;  // cosine between a face and its vertices' reference normals

/// Returns the negated maximum of the cosines of the three angles: larger is better, -1 for a needle.
float angle_quality(const std::array<Vec3, 3>& p) {
    float largest_cosine = -1;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = p[(i + 1) % 3] - p[i], b = p[(i + 2) % 3] - p[i];
        const float lengths = a.norm() * b.norm();
        largest_cosine = std::max(largest_cosine, lengths > 0 ? a.dot(b) / lengths : 1.0f);
    }
    return -largest_cosine;
}

bool has_corner(const Face& face, std::uint32_t v) {
    return face[0] == v || face[1] == v || face[2] == v;
}

}  // namespace

EditMesh::EditMesh(const TriangleMesh& mesh)
    : positions_(mesh.vertices),
      normals_(vertex_normals(mesh)),
      faces_(mesh.faces),
      alive_(mesh.faces.size(), true),
      faces_of_(mesh.vertices.size()),
      marks_(mesh.vertices.size(), 0),
      live_faces_(mesh.faces.size()) {
    for (auto& list : faces_of_) list.reserve(8);
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
        for (const std::uint32_t v : faces_[f]) faces_of_[v].push_back(f);
}

void EditMesh::move(std::uint32_t v, const Vec3& position, const Vec3& normal) {
    positions_[v] = position;
    normals_[v] = normal;
}

std::span<const std::uint32_t> EditMesh::neighbors(std::uint32_t v) {
    neighbors_.clear();
    marks_[v] = ++mark_;
    for (const std::uint32_t f : faces_of_[v]) {
        for (const std::uint32_t u : faces_[f]) {
            if (marks_[u] == mark_) continue;
            marks_[u] = mark_;
            neighbors_.push_back(u);
        }
    }
    return neighbors_;
}

std::vector<std::array<std::uint32_t, 2>> EditMesh::edges() const {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        if (!alive_[f]) continue;
        // Faces of an oriented closed mesh traverse each edge once in either direction.
        for (std::size_t i = 0; i < 3; ++i)
            if (faces_[f][i] < faces_[f][(i + 1) % 3]) edges.push_back({faces_[f][i], faces_[f][(i + 1) % 3]});
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

std::array<Vec3, 3> EditMesh::corners(const Face& face) const {
    return {positions_[face[0]], positions_[face[1]], positions_[face[2]]};
}

bool EditMesh::is_folded(const std::array<Vec3, 3>& p, const Vec3& reference) const {
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]);
    return normal.dot(reference) <= k_min_facing * normal.norm() * reference.norm();
}

bool EditMesh::survives_merge(std::uint32_t v, std::uint32_t other, const Vec3& position, const Vec3& normal) const {
    for (const std::uint32_t f : faces_of_[v]) {
        const Face& face = faces_[f];
        if (has_corner(face, other)) continue;
        std::array<Vec3, 3> moved = corners(face);
        Vec3 reference = normal;
        for (std::size_t i = 0; i < 3; ++i) {
            if (face[i] == v) {
                moved[i] = position;
            } else {
                reference += normals_[face[i]];
            }
        }
        if (is_folded(moved, reference)) return false;
    }
    return true;
}

/// Checks the link condition: a and b share exactly the two vertices opposite to their edge.
bool EditMesh::are_linked_safely(std::uint32_t a, std::uint32_t b) {
    neighbors(a);  // marks the neighbors
    std::array<std::uint32_t, 2> seen{k_invalid_index, k_invalid_index};
    for (const std::uint32_t f : faces_of_[b]) {
        for (const std::uint32_t u : faces_[f]) {
            if (u == a || u == b || marks_[u] != mark_ || u == seen[0] || u == seen[1]) continue;
            if (seen[1] != k_invalid_index) return false;  // a third shared vertex
            seen[seen[0] == k_invalid_index ? 0 : 1] = u;
        }
    }
    if (seen[1] == k_invalid_index) return false;
    // The opposite vertices lose one face each, and must keep three.
    return faces_of_[seen[0]].size() > 3 && faces_of_[seen[1]].size() > 3 &&
           faces_of_[a].size() + faces_of_[b].size() <= k_max_valence + 4;
}

void EditMesh::drop_face(std::uint32_t f, std::uint32_t v) {
    auto& list = faces_of_[v];
    list.erase(std::find(list.begin(), list.end(), f));
}

bool EditMesh::collapse(std::uint32_t kept, std::uint32_t gone) {
    const Vec3 position = (positions_[kept] + positions_[gone]) / 2;
    const Vec3 normal = (normals_[kept] + normals_[gone]).normalized();
    if (!are_linked_safely(kept, gone)) return false;
    if (!survives_merge(kept, gone, position, normal) || !survives_merge(gone, kept, position, normal)) return false;
    for (const std::uint32_t f : std::vector<std::uint32_t>(faces_of_[gone])) {
        if (has_corner(faces_[f], kept)) {
            for (const std::uint32_t v : faces_[f]) drop_face(f, v);
            alive_[f] = false;
            --live_faces_;
        } else {
            std::replace(faces_[f].begin(), faces_[f].end(), gone, kept);
            faces_of_[kept].push_back(f);
        }
    }
    faces_of_[gone].clear();
    move(kept, position, normal);
    return true;
}

bool EditMesh::improve_edge(std::uint32_t a, std::uint32_t b) {
    std::array<std::uint32_t, 2> sides{};  // the faces that traverse a -> b and b -> a
    std::array<std::uint32_t, 2> tips{};
    std::size_t found = 0;
    for (const std::uint32_t f : faces_of_[a]) {
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t from = faces_[f][i], to = faces_[f][(i + 1) % 3];
            if ((from != a || to != b) && (from != b || to != a)) continue;
            const std::size_t side = from == a ? 0 : 1;
            sides[side] = f;
            tips[side] = faces_[f][(i + 2) % 3];
            ++found;
        }
    }
    if (found != 2 || faces_of_[a].size() <= 3 || faces_of_[b].size() <= 3) return false;
    const auto linked = neighbors(tips[0]);
    if (std::find(linked.begin(), linked.end(), tips[1]) != linked.end()) return false;

    const Face left{a, tips[1], tips[0]}, right{b, tips[0], tips[1]};
    const float before = std::min(angle_quality(corners(faces_[sides[0]])), angle_quality(corners(faces_[sides[1]])));
    const float after = std::min(angle_quality(corners(left)), angle_quality(corners(right)));
    if (after <= before + 1e-3f) return false;
    // A flip across a crease would cut it off, so both new faces must agree with the normals of all four vertices.
    const Vec3 reference = normals_[a] + normals_[b] + normals_[tips[0]] + normals_[tips[1]];
    const std::array<Vec3, 3> l = corners(left), r = corners(right);
    const Vec3 nl = (l[1] - l[0]).cross(l[2] - l[0]), nr = (r[1] - r[0]).cross(r[2] - r[0]);
    if (is_folded(l, reference) || is_folded(r, reference) || nl.dot(nr) < 0.7f * nl.norm() * nr.norm()) return false;

    faces_[sides[0]] = left;
    faces_[sides[1]] = right;
    drop_face(sides[1], a);
    drop_face(sides[0], b);
    faces_of_[tips[0]].push_back(sides[1]);
    faces_of_[tips[1]].push_back(sides[0]);
    return true;
}

bool EditMesh::can_move(std::uint32_t v, const Vec3& position, const Vec3& normal) const {
    return survives_merge(v, k_invalid_index, position, normal);
}

TriangleMesh EditMesh::compact() const {
    TriangleMesh mesh;
    std::vector<std::uint32_t> renamed(positions_.size(), 0);
    for (std::uint32_t v = 0; v < positions_.size(); ++v) {
        if (!is_live(v)) continue;
        renamed[v] = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.push_back(positions_[v]);
    }
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        const Face& face = faces_[f];
        if (alive_[f]) mesh.faces.push_back({renamed[face[0]], renamed[face[1]], renamed[face[2]]});
    }
    mesh.source_face_count = static_cast<std::uint32_t>(mesh.faces.size());
    return mesh;
}

}  // namespace exemplar
