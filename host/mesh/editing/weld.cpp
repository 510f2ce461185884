#include "host/mesh/editing/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>

namespace exemplar {
namespace {

double largest_coordinate(const TriangleMesh& mesh) {
    float largest = 0;
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face)
            if (mesh.vertices[v].allFinite()) largest = std::max(largest, mesh.vertices[v].cwiseAbs().maxCoeff());
    return largest;
}

double longest_edge(const TriangleMesh& mesh, const Face& face) {
    const Vec3d a = mesh.vertices[face[0]].cast<double>(), b = mesh.vertices[face[1]].cast<double>(),
                c = mesh.vertices[face[2]].cast<double>();
    return std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
}

/// Returns, for each vertex, the length of the shortest face around it; the length of a face is that of its longest
/// edge. Faces that are a point or not finite do not count; infinity for a vertex without any other.
std::vector<double> shortest_face_lengths(const TriangleMesh& mesh) {
    std::vector<double> shortest(mesh.vertex_count(), std::numeric_limits<double>::infinity());
    for (const Face& face : mesh.faces) {
        const double length = longest_edge(mesh, face);
        if (!(length > 0)) continue;
        for (const std::uint32_t v : face) shortest[v] = std::min(shortest[v], length);
    }
    return shortest;
}

/// Finds, for each vertex, an earlier one that is as near as rounding. A vertex has a radius, the rounding divided by a
/// power of two, its level. Two vertices are one if they are within the smaller of their radii. Those that stay lie in
/// a grid for each level. They are more than their radius apart, so cells hold a bounded number and all takes linear
/// time.
class NearVertices {
  public:
    explicit NearVertices(const TriangleMesh& mesh)
        : mesh_(mesh),
          rounding_(k_weld_roundings * largest_coordinate(mesh) * std::numeric_limits<float>::epsilon()),
          level_(mesh.vertex_count(), 0),
          next_(mesh.vertex_count(), k_end) {}

    /// Returns the vertex that replaces each vertex, itself if it stays. One that replaces others stays.
    std::vector<std::uint32_t> representatives() {
        const std::vector<double> length = shortest_face_lengths(mesh_);
        std::vector<std::uint32_t> representative(mesh_.vertex_count());
        first_.reserve(mesh_.vertex_count());
        for (std::uint32_t v = 0; v < mesh_.vertex_count(); ++v) {
            representative[v] = v;
            const std::optional<int> level = level_of(v, length[v]);
            if (!level) continue;
            level_[v] = *level;
            representative[v] = find(v).value_or(v);
            if (representative[v] == v) add(v);
        }
        return representative;
    }

  private:
    static constexpr std::uint32_t k_end = std::numeric_limits<std::uint32_t>::max();
    static constexpr int k_levels = 16;
    static constexpr double k_share_of_length = 1.0 / 1024, k_radii_per_cell = 8;
    using Cell = std::array<std::int64_t, 3>;

    double radius(int level) const { return std::ldexp(rounding_, -level); }

    /// Returns nothing for a vertex that is only joined to equal ones: its faces are too small.
    std::optional<int> level_of(std::uint32_t v, double length) const {
        if (!std::isfinite(length) || !mesh_.vertices[v].allFinite()) return {};
        for (int level = 0; level < k_levels; ++level)
            if (radius(level) <= k_share_of_length * length) return level;
        return {};
    }

    Cell cell_of(const Vec3d& p, int level) const {
        const Vec3d cell = (p / (k_radii_per_cell * radius(level))).array().floor();
        return {static_cast<std::int64_t>(cell[0]), static_cast<std::int64_t>(cell[1]),
                static_cast<std::int64_t>(cell[2])};
    }
    /// Cells of one key only share a list.
    static std::uint64_t key_of(const Cell& cell, int level) {
        auto key = static_cast<std::uint64_t>(level);
        for (const std::int64_t i : cell) {
            key = (key ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15ULL;
            key ^= key >> 29;
        }
        return key;
    }

    void add(std::uint32_t v) {
        const int level = level_[v];
        is_used_[static_cast<std::size_t>(level)] = true;
        const std::uint64_t key = key_of(cell_of(mesh_.vertices[v].cast<double>(), level), level);
        const auto [it, added] = first_.try_emplace(key, v);
        if (added) return;
        next_[v] = it->second;
        it->second = v;
    }

    /// Returns the first vertex that stays and is as near as rounding.
    std::optional<std::uint32_t> find(std::uint32_t v) const {
        std::uint32_t found = k_end;
        for (int level = 0; level < k_levels; ++level)
            if (is_used_[static_cast<std::size_t>(level)]) found = std::min(found, find_at(v, level));
        return found == k_end ? std::nullopt : std::optional(found);
    }
    std::uint32_t find_at(std::uint32_t v, int level) const {
        const Vec3d p = mesh_.vertices[v].cast<double>();
        const double reach = radius(std::max(level, level_[v]));
        const Cell low = cell_of(p.array() - reach, level), high = cell_of(p.array() + reach, level);
        std::uint32_t found = k_end;
        for (std::int64_t x = low[0]; x <= high[0]; ++x)
            for (std::int64_t y = low[1]; y <= high[1]; ++y)
                for (std::int64_t z = low[2]; z <= high[2]; ++z)
                    found = std::min(found, find_in(key_of({x, y, z}, level), p, reach));
        return found;
    }
    std::uint32_t find_in(std::uint64_t key, const Vec3d& p, double reach) const {
        const auto first = first_.find(key);
        std::uint32_t found = k_end;
        for (std::uint32_t v = first == first_.end() ? k_end : first->second; v != k_end; v = next_[v])
            if ((mesh_.vertices[v].cast<double>() - p).cwiseAbs().maxCoeff() <= reach) found = std::min(found, v);
        return found;
    }

    const TriangleMesh& mesh_;
    double rounding_;
    std::vector<int> level_;
    std::array<bool, k_levels> is_used_{};
    std::unordered_map<std::uint64_t, std::uint32_t> first_;  ///< of the vertices in each cell
    std::vector<std::uint32_t> next_;                         ///< in the cell of each vertex
};

/// Moves the corners of faces to the representatives, and removes all other vertices.
void replace_vertices(TriangleMesh& mesh, const std::vector<std::uint32_t>& representative) {
    std::vector<std::uint32_t> number(mesh.vertex_count());
    std::vector<Vec3> vertices;
    for (std::uint32_t v = 0; v < mesh.vertex_count(); ++v) {
        number[v] = representative[v] == v ? static_cast<std::uint32_t>(vertices.size()) : number[representative[v]];
        if (representative[v] == v) vertices.push_back(mesh.vertices[v]);
    }
    mesh.vertices = std::move(vertices);
    for (Face& face : mesh.faces)
        for (std::uint32_t& v : face) v = number[v];
}

/// Returns the mesh with one vertex per bit pattern of a position.
TriangleMesh with_equal_joined(const TriangleMesh& mesh) {
    TriangleMesh result = mesh;
    result.vertices.clear();
    VertexWelder welder;
    std::vector<std::uint32_t> vertex;
    vertex.reserve(mesh.vertex_count());
    for (const Vec3& position : mesh.vertices) vertex.push_back(welder.add(position, result.vertices));
    for (Face& face : result.faces)
        for (std::uint32_t& v : face) v = vertex[v];
    return result;
}

}  // namespace

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
    TriangleMesh result = with_equal_joined(mesh);
    replace_vertices(result, NearVertices(result).representatives());
    return result;
}

}  // namespace exemplar
