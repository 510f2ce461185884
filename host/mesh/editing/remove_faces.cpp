#include "host/mesh/editing/remove_faces.h"

#include <utility>

namespace exemplar {

std::size_t remove_faces(TriangleMesh& mesh, const std::vector<bool>& is_removed) {
    std::vector<Face> faces;
    std::vector<std::uint32_t> source_face;
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        if (is_removed[f]) continue;
        faces.push_back(mesh.faces[f]);
        source_face.push_back(mesh.source_of(f));
    }
    const std::size_t removed = mesh.face_count() - faces.size();
    if (removed == 0) return 0;
    mesh.faces = std::move(faces);
    mesh.source_face = std::move(source_face);
    return removed;
}

std::size_t remove_collapsed_faces(TriangleMesh& mesh) {
    std::vector<bool> is_removed(mesh.face_count());
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const auto& [a, b, c] = mesh.faces[f];
        is_removed[f] = a == b || b == c || c == a;
    }
    return remove_faces(mesh, is_removed);
}

}  // namespace exemplar
