// The same shape in other triangles.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/mesh/editing/simplify.h"
#include "host/mesh/editing/weld.h"
#include "host/mesh/queries/point_tree.h"
#include "host/mesh/topology.h"
#include "host/synth/damage/damage_kinds.h"

namespace exemplar {
namespace {

std::uint32_t add_vertex(TriangleMesh& mesh, const Vec3d& position) {
    mesh.vertices.push_back(position.cast<float>());
    return static_cast<std::uint32_t>(mesh.vertex_count() - 1);
}

/// Returns the corner at which the side a-b of a face (in either direction) begins; 3 if there is none.
std::size_t side_between(const Face& face, const std::array<std::uint32_t, 2>& edge) {
    for (std::size_t k = 0; k < 3; ++k)
        if (std::minmax(face[k], face[(k + 1) % 3]) == std::minmax(edge[0], edge[1])) return k;
    return 3;
}

/// Finds the face whose center is nearest to a point, preferably one that faces the same way.
class NearestFace {
  public:
    explicit NearestFace(const TriangleMesh& mesh) : normals_(face_normals(mesh)), centers_(face_centers(mesh)) {}

    std::uint32_t find(const Vec3& point, const Vec3& normal) const {
        constexpr std::size_t k_candidates = 8;  // the other side of a thin wall can be nearer
        std::array<std::uint32_t, k_candidates> face{};
        const std::size_t found = centers_.nearest(point, face);
        for (std::size_t i = 0; i < found; ++i)
            if (normals_[face[i]].dot(normal) > 0) return face[i];
        return face[0];
    }

  private:
    std::vector<Vec3> normals_;
    PointTree centers_;
};

/// Cuts every face into n x n equal ones. Sides with the same two vertices are cut at the same points.
DamagedMesh refine(const TriangleMesh& mesh, std::uint32_t n) {
    using Share = std::pair<std::uint32_t, std::uint32_t>;  // a corner and its weight in n-ths
    DamagedMesh damaged = undamaged(mesh);
    damaged.mesh.faces.clear();
    damaged.origin.clear();
    std::map<std::array<Share, 3>, std::uint32_t> known;
    const auto point = [&](const Face& face, std::uint32_t row, std::uint32_t column) {
        const std::array<std::uint32_t, 3> weight{n - row, row - column, column};
        std::array<Share, 3> shares;
        for (std::size_t k = 0; k < 3; ++k)
            shares[k] = weight[k] > 0 ? Share{face[k], weight[k]} : Share{k_invalid_index, 0};
        std::ranges::sort(shares);
        if (shares[0].second == n) return shares[0].first;
        const auto [it, fresh] = known.try_emplace(shares, 0);
        if (!fresh) return it->second;
        Vec3d sum = Vec3d::Zero();
        for (const auto& [corner, share] : shares)
            if (share > 0) sum += share * mesh.vertices[corner].cast<double>();
        return it->second = add_vertex(damaged.mesh, sum / n);
    };
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        for (std::uint32_t row = 0; row < n; ++row)
            for (std::uint32_t column = 0; column <= row; ++column) {
                const Face& face = mesh.faces[f];
                const std::uint32_t a = point(face, row, column), b = point(face, row + 1, column),
                                    c = point(face, row + 1, column + 1);
                add_face(damaged, {a, b, c}, f);
                if (column < row) add_face(damaged, {a, c, point(face, row, column + 1)}, f);
            }
    return damaged;
}

/// Two triangles as a quad: its corners in order, cut from the first to the third.
struct Quad {
    std::array<std::uint32_t, 4> corner;
    std::array<std::uint32_t, 2> origin;  ///< the triangles with the corners 0 1 2 and 2 3 0
};

Vec3d normal_of(const TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3d p = mesh.vertices[a].cast<double>();
    return (mesh.vertices[b].cast<double>() - p).cross(mesh.vertices[c].cast<double>() - p).normalized();
}

/// Returns whether a quad is nearly flat and convex: its triangles face the same way for either diagonal.
bool is_good_quad(const TriangleMesh& mesh, const Quad& quad) {
    constexpr double k_min_cosine = 0.9;
    const auto& [a, b, c, d] = quad.corner;
    const Vec3d normal = normal_of(mesh, a, b, c);
    for (const Vec3d& other : {normal_of(mesh, c, d, a), normal_of(mesh, b, c, d), normal_of(mesh, d, a, b)})
        if (!(normal.dot(other) > k_min_cosine)) return false;
    return true;
}

/// Joins the two faces at an edge to a quad; returns false if they are oriented differently or would not make a good
/// one.
bool make_quad(const TriangleMesh& mesh, const Edge& edge, Quad& quad) {
    const Face &first = mesh.faces[edge.face[0]], &second = mesh.faces[edge.face[1]];
    const std::size_t i = side_between(first, edge.vertex), j = side_between(second, edge.vertex);
    if (i == 3 || j == 3 || first[i] != second[(j + 1) % 3]) return false;
    // The diagonal runs from first[i + 1] to first[i].
    quad = {{first[(i + 1) % 3], first[(i + 2) % 3], first[i], second[(j + 2) % 3]}, {edge.face[0], edge.face[1]}};
    return quad.corner[1] != quad.corner[3] && is_good_quad(mesh, quad);
}

/// Cuts a quad along its other diagonal; the origin of each half is the old triangle with the nearer center.
Quad turned(const TriangleMesh& mesh, const Quad& quad) {
    const auto& [a, b, c, d] = quad.corner;
    const auto center = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        return Vec3((mesh.vertices[i] + mesh.vertices[j] + mesh.vertices[k]) / 3);
    };
    const Vec3 old = center(a, b, c), other = center(c, d, a);
    const auto nearer = [&](const Vec3& p) { return quad.origin[(p - other).norm() < (p - old).norm()]; };
    return {{b, c, d, a}, {nearer(center(b, c, d)), nearer(center(d, a, b))}};
}

}  // namespace

DamagedMesh make_slivers(const TriangleMesh& mesh, std::uint64_t seed) {
    constexpr double k_from_end = 1e-3;
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const std::vector<Edge> edges = build_topology(mesh).edges;
    std::vector<bool> split(mesh.face_count(), false);  // each face is split at most once
    for (const std::uint32_t e : random_share(edges.size(), 0.05, random)) {
        const Edge& edge = edges[e];
        const auto same = [&](std::size_t other) { return other < edges.size() && edges[other].vertex == edge.vertex; };
        if (same(e + 1) || (e > 0 && same(e - 1))) continue;  // more than two faces
        if (split[edge.face[0]] || (!edge.is_boundary() && split[edge.face[1]])) continue;
        const Vec3d a = mesh.vertices[edge.vertex[0]].cast<double>(), b = mesh.vertices[edge.vertex[1]].cast<double>();
        const std::uint32_t middle = add_vertex(damaged.mesh, a + k_from_end * (b - a));
        for (const std::uint32_t f : edge.face) {
            if (f == k_invalid_index) continue;
            const std::size_t k = side_between(mesh.faces[f], edge.vertex);
            Face rest = mesh.faces[f];
            damaged.mesh.faces[f][(k + 1) % 3] = middle;
            rest[k] = middle;
            add_face(damaged, rest, f);
            split[f] = true;
        }
    }
    return damaged;
}

DamagedMesh decimate(const TriangleMesh& mesh, std::uint64_t) {
    constexpr std::size_t k_part = 10, k_fewest = 20;
    DamagedMesh damaged = undamaged(mesh);
    try {
        damaged.mesh = simplify_mesh(welded(mesh), std::max(mesh.face_count() / k_part, k_fewest)).mesh;
    } catch (const MeshError&) {
        return damaged;  // no coarser mesh exists: there is no area, or all pieces are too small
    }
    damaged.mesh.source_face.clear();  // a mesh of few faces is returned with its polygons
    damaged.mesh.source_face_count = static_cast<std::uint32_t>(damaged.mesh.face_count());
    const NearestFace nearest(mesh);
    const std::vector<Vec3> centers = face_centers(damaged.mesh), normals = face_normals(damaged.mesh);
    damaged.origin.resize(damaged.mesh.face_count());
    parallel_for(
        damaged.origin.size(), [&](std::size_t f) { damaged.origin[f] = nearest.find(centers[f], normals[f]); }, 256);
    return damaged;
}

DamagedMesh refine_to_4(const TriangleMesh& mesh, std::uint64_t) {
    return refine(mesh, 2);
}

DamagedMesh refine_to_9(const TriangleMesh& mesh, std::uint64_t) {
    return refine(mesh, 3);
}

DamagedMesh pair_to_quads(const TriangleMesh& mesh, std::uint64_t seed) {
    Random random(seed);
    const std::vector<Edge> edges = build_topology(mesh).edges;
    std::set<std::array<std::uint32_t, 2>> taken;  // vertex pairs that an edge joins
    for (const Edge& edge : edges) taken.insert(edge.vertex);
    DamagedMesh damaged = undamaged(mesh);
    damaged.mesh.faces.clear();
    damaged.origin.clear();
    std::vector<bool> paired(mesh.face_count(), false);
    const auto add = [&](const Face& face, std::uint32_t origin, std::uint32_t polygon) {
        add_face(damaged, face, origin);
        damaged.mesh.source_face.push_back(polygon);
    };
    std::uint32_t polygons = 0;
    for (const std::uint32_t e : random_share(edges.size(), 1, random)) {
        Quad quad;
        if (edges[e].is_boundary() || paired[edges[e].face[0]] || paired[edges[e].face[1]]) continue;
        if (!make_quad(mesh, edges[e], quad)) continue;
        for (const std::uint32_t f : quad.origin) paired[f] = true;
        const auto [low, high] = std::minmax(quad.corner[1], quad.corner[3]);
        if (random.uniform() < 0.5 && taken.insert({low, high}).second) quad = turned(mesh, quad);
        const auto& [a, b, c, d] = quad.corner;
        add({a, b, c}, quad.origin[0], polygons);
        add({c, d, a}, quad.origin[1], polygons++);
    }
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
        if (!paired[f]) add(mesh.faces[f], f, polygons++);
    damaged.mesh.source_face_count = polygons;
    return damaged;
}

}  // namespace exemplar
