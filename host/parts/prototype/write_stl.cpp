#include "host/parts/prototype/write_stl.h"

#include <algorithm>
#include <array>
#include <ostream>
#include <string>

#include "host/core/errors.h"
#include "host/core/files.h"

namespace exemplar {
namespace {

template <typename T>
void append_raw(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_stl(const std::filesystem::path& path, const TriangleMesh& mesh) {
    if (mesh.faces.empty()) throw MeshError(path.string() + ": a mesh without faces cannot be printed");
    if (!std::all_of(mesh.vertices.begin(), mesh.vertices.end(), [](const Vec3& v) { return v.allFinite(); }))
        throw MeshError(path.string() + ": a vertex is not finite");
    std::string bytes(80, ' ');
    bytes.replace(0, 30, "written by Exemplar, in mm    ");
    append_raw(bytes, static_cast<std::uint32_t>(mesh.face_count()));
    for (const Face& face : mesh.faces) {
        const std::array<Vec3, 3> corner{mesh.vertices[face[0]], mesh.vertices[face[1]], mesh.vertices[face[2]]};
        const Vec3 normal = unit_or_up((corner[1] - corner[0]).cross(corner[2] - corner[0]).cast<double>());
        for (const Vec3& v : {normal, corner[0], corner[1], corner[2]})
            for (Eigen::Index i = 0; i < 3; ++i) append_raw(bytes, v[i]);
        append_raw(bytes, std::uint16_t{0});
    }
    write_file_atomically(path, [&](std::ostream& out) { out << bytes; });
}

}  // namespace exemplar
