#include <cstdint>

#include "apps/import/write.h"
#include "host/mesh/io/io_write_text.h"

namespace exemplar::import {

std::string still_ply(const Scene& scene) {
    std::string rows, corners;
    std::uint64_t vertices = 0, faces = 0;
    for (const SceneMesh& placed : scene.meshes) {
        const auto first = static_cast<std::uint32_t>(vertices);
        for (const Position& p : positions_at_rest(scene, placed))
            for (const double coordinate : {p.x, p.y, p.z}) mesh_io::append_bytes(rows, coordinate);
        vertices += placed.mesh->mNumVertices;
        for (const std::vector<std::uint32_t>& polygon : polygons_of(*placed.mesh, is_mirrored(scene, placed))) {
            mesh_io::append_bytes(corners, static_cast<std::uint32_t>(polygon.size()));
            for (const std::uint32_t corner : polygon) mesh_io::append_bytes(corners, first + corner);
            ++faces;
        }
    }
    return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " + std::to_string(faces) +
           "\nproperty list uint uint vertex_indices\nend_header\n" + rows + corners;
}

}  // namespace exemplar::import
