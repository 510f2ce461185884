#include "gpu/imaging/mesh_part.h"

#include <algorithm>
#include <cstdint>
#include <limits>

namespace exemplar {

MeshPart cut_part(const MeshSurface& surface, std::size_t first, std::size_t count) {
    constexpr std::uint32_t k_unused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> place(surface.vertices.size(), k_unused);
    MeshPart part;
    if (!surface.colors.empty()) {
        const auto colors = surface.colors.subspan(first, count);
        part.colors.assign(colors.begin(), colors.end());
    }
    if (!surface.vertex_normals && !surface.normals.empty()) {
        const auto normals = surface.normals.subspan(first, count);
        part.normals.assign(normals.begin(), normals.end());
    }
    for (Face face : surface.faces.subspan(first, count)) {
        for (auto& vertex : face) {
            std::uint32_t& here = place[vertex];
            if (here == k_unused) {
                here = static_cast<std::uint32_t>(part.vertices.size());
                part.vertices.push_back(surface.vertices[vertex]);
                if (surface.vertex_normals) part.normals.push_back(surface.normals[vertex]);
            }
            vertex = here;
        }
        part.faces.push_back(face);
    }
    return part;
}

std::size_t faces_per_part(std::size_t bytes) {
    return std::max<std::size_t>(bytes / (3 * sizeof(Vec3)), 1);
}

bool fits(const MeshSurface& surface, std::size_t bytes) {
    // The largest buffers are those of one vector per corner, vertex or face.
    const std::size_t most = std::max({surface.faces.size(), surface.vertices.size(), surface.normals.size()});
    return most <= bytes / sizeof(Vec3);
}

}  // namespace exemplar
