#include "host/mesh/editing/nested_pieces.h"

#include <algorithm>

#include "host/mesh/editing/area_vector.h"
#include "host/mesh/queries/rays.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

/// The faces of the pieces that take part, ready for rays.
struct PieceScene {
    TriangleMesh mesh;
    std::vector<std::uint32_t> piece;  ///< of each face of `mesh`
    float rounding = 0;                ///< of a hit's place, in mesh units
};

PieceScene closed_pieces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& piece_of_face,
                         const std::vector<int>& volume_sign) {
    PieceScene scene;
    scene.mesh.vertices = mesh.vertices;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        if (volume_sign[piece_of_face[f]] == 0) continue;
        scene.mesh.faces.push_back(mesh.faces[f]);
        scene.piece.push_back(piece_of_face[f]);
        for (const std::uint32_t v : mesh.faces[f])
            scene.rounding = std::max(scene.rounding, 1e-6f * mesh.vertices[v].cwiseAbs().maxCoeff());
    }
    return scene;
}

/// Returns the innermost piece around the start of a ray that leaves `from`: the first that the ray leaves without
/// having entered it before. Only the first hit with each piece counts, so hits need not be counted exactly.
std::uint32_t first_piece_left(const PieceScene& scene, const RayScene& rays, const std::vector<int>& volume_sign,
                               std::uint32_t from, const Vec3& origin) {
    constexpr int k_max_hits = 4096;
    const Vec3 direction = Vec3(0.577f, 0.211f, 0.789f).normalized();  // along no axis that shapes are built on
    std::vector<std::uint32_t> entered{from};
    float near = 0;
    for (int i = 0; i < k_max_hits; ++i) {
        const auto hit = rays.first_hit(origin, direction, near);
        if (!hit) return k_invalid_index;
        // A step beyond rounding, or the ray would hit the same face again.
        near = hit->distance * (1 + 1e-6f) + scene.rounding;
        const std::uint32_t piece = scene.piece[hit->face];
        if (std::ranges::find(entered, piece) != entered.end()) continue;
        const double slope = doubled_area_vector(scene.mesh, scene.mesh.faces[hit->face]).dot(direction.cast<double>());
        if (slope * volume_sign[piece] > 0) return piece;
        entered.push_back(piece);
    }
    return k_invalid_index;
}

}  // namespace

std::vector<std::uint32_t> enclosing_pieces(const TriangleMesh& mesh, const std::vector<std::uint32_t>& piece_of_face,
                                            const std::vector<int>& volume_sign) {
    std::vector<std::uint32_t> enclosing(volume_sign.size(), k_invalid_index);
    const PieceScene scene = closed_pieces(mesh, piece_of_face, volume_sign);
    const RayScene rays(scene.mesh);
    std::vector<bool> is_done(volume_sign.size());
    for (std::uint32_t f = 0; f < scene.mesh.face_count(); ++f) {
        const std::uint32_t piece = scene.piece[f];
        if (is_done[piece]) continue;
        is_done[piece] = true;
        const auto& [a, b, c] = scene.mesh.faces[f];
        const Vec3 center = (scene.mesh.vertices[a] + scene.mesh.vertices[b] + scene.mesh.vertices[c]) / 3;
        enclosing[piece] = first_piece_left(scene, rays, volume_sign, piece, center);
    }
    return enclosing;
}

}  // namespace exemplar
