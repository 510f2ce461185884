// Reads what exemplar-import makes of a file: lines "warning TEXT", then a binary PLY file. Its process may have been
// damaged by the file that it read, so its output is trusted no more than the file.
#include "host/mesh/io/io_import.h"

#include <algorithm>
#include <array>

#include "host/mesh/editing/weld.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_text.h"

namespace exemplar::mesh_io {
namespace {

/// Joins vertices at equal positions, which such files have for each normal and texture coordinate.
void join_vertices(MeshFile& file) {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> number;
    VertexWelder welder;
    for (const Vec3& position : file.mesh.vertices) number.push_back(welder.add(position, vertices));
    for (Face& face : file.mesh.faces)
        for (std::uint32_t& v : face) v = number[v];
    for (std::uint32_t& v : file.polygons.corners) v = number[v];
    file.mesh.vertices = std::move(vertices);
}

}  // namespace

bool is_imported(std::string_view extension) {
    constexpr std::array<std::string_view, 4> k_imported{".fbx", ".dae", ".3mf", ".3ds"};
    return std::ranges::find(k_imported, extension) != k_imported.end();
}

std::vector<std::string> take_import_warnings(std::string_view& output) {
    constexpr std::string_view k_begin = "warning ";
    constexpr std::size_t k_most = 100;
    std::vector<std::string> warnings;
    while (output.starts_with(k_begin)) {
        const std::size_t end = std::min(output.find('\n'), output.size());
        const std::string_view text = output.substr(k_begin.size(), end - k_begin.size());
        if (!text.empty() && warnings.size() < k_most) warnings.push_back(printable(text, 300));
        output.remove_prefix(std::min(end + 1, output.size()));
    }
    return warnings;
}

MeshFile mesh_of_import(std::string_view output, const std::string& name) {
    std::vector<std::string> warnings = take_import_warnings(output);
    MeshFile file = read_ply(output, name);
    join_vertices(file);
    file.warnings.insert(file.warnings.begin(), warnings.begin(), warnings.end());
    return file;
}

}  // namespace exemplar::mesh_io
