#include <algorithm>
#include <ostream>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/io/io.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar {

void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh) {
    constexpr std::size_t k_header_bytes = 80, k_triangle_bytes = 50;
    if (!std::ranges::all_of(mesh.vertices, [](const Vec3& v) { return v.allFinite(); }))
        throw MeshError(path.string() + ": a vertex is not finite, which cannot be printed");
    std::string bytes("binary STL of Exemplar");
    bytes.resize(k_header_bytes, ' ');
    bytes.reserve(k_header_bytes + 4 + k_triangle_bytes * mesh.face_count());
    mesh_io::append_bytes(bytes, static_cast<std::uint32_t>(mesh.face_count()));
    const std::vector<Vec3> normals = face_normals(mesh);
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        for (int i = 0; i < 3; ++i) mesh_io::append_bytes(bytes, normals[f][i]);
        for (const std::uint32_t v : mesh.faces[f])
            for (int i = 0; i < 3; ++i)
                mesh_io::append_bytes(bytes, static_cast<float>(mesh.origin[i] + double{mesh.vertices[v][i]}));
        mesh_io::append_bytes(bytes, std::uint16_t{0});
    }
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
