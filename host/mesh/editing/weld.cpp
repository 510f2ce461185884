#include "host/mesh/editing/weld.h"

#include <bit>

namespace exemplar {

std::size_t VertexWelder::Hash::operator()(const Key& key) const {
    std::uint64_t h = (std::uint64_t{key.bits[0]} << 32 | key.bits[1]) * 0x9e3779b97f4a7c15ULL;
    h = (h ^ h >> 29 ^ key.bits[2]) * 0xbf58476d1ce4e5b9ULL;
    return h ^ h >> 32;
}

std::uint32_t VertexWelder::add(const Vec3& position, std::vector<Vec3>& vertices) {
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x == 0 ? 0.0f : x); };
    const Key key{{bits(position[0]), bits(position[1]), bits(position[2])}};
    const auto [it, added] = index_.try_emplace(key, static_cast<std::uint32_t>(vertices.size()));
    if (added) vertices.push_back(position);
    return it->second;
}

TriangleMesh welded(const TriangleMesh& mesh) {
    TriangleMesh result;
    VertexWelder welder;
    std::vector<std::uint32_t> vertex;
    vertex.reserve(mesh.vertex_count());
    for (const Vec3& position : mesh.vertices) vertex.push_back(welder.add(position, result.vertices));
    result.faces = mesh.faces;
    for (Face& face : result.faces)
        for (std::uint32_t& v : face) v = vertex[v];
    result.source_face = mesh.source_face;
    result.source_face_count = mesh.source_face_count;
    return result;
}

}  // namespace exemplar
