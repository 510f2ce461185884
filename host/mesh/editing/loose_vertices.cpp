#include "host/mesh/editing/loose_vertices.h"

namespace exemplar {

std::vector<std::uint32_t> vertices_of_faces(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.vertex_count());
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face) used[v] = true;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < used.size(); ++v)
        if (used[v]) vertices.push_back(v);
    return vertices;
}

TriangleMesh without_loose_vertices(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> kept = vertices_of_faces(mesh);
    TriangleMesh result = mesh;
    result.vertices.clear();
    std::vector<std::uint32_t> place(mesh.vertex_count());
    for (const std::uint32_t v : kept) {
        place[v] = static_cast<std::uint32_t>(result.vertices.size());
        result.vertices.push_back(mesh.vertices[v]);
    }
    for (Face& face : result.faces)
        for (std::uint32_t& v : face) v = place[v];
    return result;
}

}  // namespace exemplar
