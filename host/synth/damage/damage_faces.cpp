// Missing, duplicate, reversed or separated faces.

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <utility>

#include "host/mesh/topology.h"
#include "host/synth/damage/damage_kinds.h"

namespace exemplar {
namespace {

/// Removes a patch of `count` faces around a random one, nearest by the number of crossed edges.
void remove_patch(const Topology& topology, std::size_t count, Random& random, std::vector<bool>& kept) {
    std::vector<std::uint32_t> patch{static_cast<std::uint32_t>(random.index(kept.size()))};
    std::vector<bool> seen(kept.size(), false);
    seen[patch[0]] = true;
    for (std::size_t i = 0; i < patch.size() && i < count; ++i) {
        kept[patch[i]] = false;
        for (const std::uint32_t e : topology.edges_of_face(patch[i]))
            for (const std::uint32_t f : topology.edges[e].face) {
                if (f == k_invalid_index || seen[f]) continue;
                seen[f] = true;
                patch.push_back(f);
            }
    }
}

}  // namespace

DamagedMesh cut_holes(const TriangleMesh& mesh, std::uint64_t seed) {
    constexpr std::size_t k_holes = 4, k_part = 50;  // one of k_part faces is removed
    DamagedMesh damaged = undamaged(mesh);
    const std::size_t count = mesh.face_count();
    if (count <= k_holes) return damaged;  // nothing would be left
    Random random(seed);
    const Topology topology = build_topology(mesh);
    std::vector<bool> kept(count, true);
    for (std::size_t hole = 0; hole < k_holes; ++hole)
        remove_patch(topology, (count + k_holes * k_part - 1) / (k_holes * k_part), random, kept);
    keep_faces(damaged, kept);
    return damaged;
}

DamagedMesh duplicate_faces(const TriangleMesh& mesh, std::uint64_t seed) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    for (const std::uint32_t f : random_share(mesh.face_count(), 0.05, random)) add_face(damaged, mesh.faces[f], f);
    return damaged;
}

DamagedMesh flip_faces(const TriangleMesh& mesh, std::uint64_t seed) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    for (const std::uint32_t f : random_share(mesh.face_count(), 0.10, random))
        std::swap(damaged.mesh.faces[f][1], damaged.mesh.faces[f][2]);
    return damaged;
}

DamagedMesh turn_inside_out(const TriangleMesh& mesh, std::uint64_t) {
    DamagedMesh damaged = undamaged(mesh);
    for (Face& face : damaged.mesh.faces) std::swap(face[1], face[2]);
    return damaged;
}

DamagedMesh split_parts(const TriangleMesh& mesh, std::uint64_t seed) {
    constexpr std::size_t k_planes = 3;  // so up to 8 regions
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const std::vector<Vec3> centers = face_centers(mesh);
    std::vector<std::uint32_t> region(mesh.face_count(), 0);
    for (std::size_t plane = 0; plane < k_planes; ++plane) {
        const Vec3& point = centers[random.index(centers.size())];
        const Vec3 normal = random_direction(random).cast<float>();
        for (std::size_t f = 0; f < centers.size(); ++f)
            region[f] = 2 * region[f] + ((centers[f] - point).dot(normal) > 0);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> own;  // (vertex, region): the region's own vertex
    std::vector<bool> taken(mesh.vertex_count(), false);
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        for (std::uint32_t& v : damaged.mesh.faces[f]) {
            const auto [it, fresh] = own.try_emplace({v, region[f]}, v);
            if (fresh && taken[v]) {
                it->second = static_cast<std::uint32_t>(damaged.mesh.vertex_count());
                damaged.mesh.vertices.push_back(mesh.vertices[v]);
            }
            taken[v] = true;
            v = it->second;
        }
    return damaged;
}

DamagedMesh unweld(const TriangleMesh& mesh, std::uint64_t) {
    DamagedMesh damaged = undamaged(mesh);
    damaged.mesh.vertices.clear();
    for (Face& face : damaged.mesh.faces)
        for (std::uint32_t& v : face) {
            damaged.mesh.vertices.push_back(mesh.vertices[v]);
            v = static_cast<std::uint32_t>(damaged.mesh.vertex_count() - 1);
        }
    return damaged;
}

DamagedMesh add_fins(const TriangleMesh& mesh, std::uint64_t seed) {
    DamagedMesh damaged = undamaged(mesh);
    Random random(seed);
    const std::vector<Vec3> normals = face_normals(mesh);
    for (const std::uint32_t f : random_share(mesh.face_count(), 0.01, random)) {
        const std::size_t side = random.index(3);
        const std::uint32_t a = mesh.faces[f][side], b = mesh.faces[f][(side + 1) % 3];
        const Vec3 &from = mesh.vertices[a], &to = mesh.vertices[b];
        damaged.mesh.vertices.emplace_back((from + to) / 2 + (to - from).norm() * normals[f]);
        add_face(damaged, {a, b, static_cast<std::uint32_t>(damaged.mesh.vertex_count() - 1)}, f);
    }
    return damaged;
}

}  // namespace exemplar
