#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

inline double signed_volume(const TriangleMesh& mesh) {
    double volume = 0;
    for (const auto& [a, b, c] : mesh.faces)
        volume += mesh.vertices[a].cross(mesh.vertices[b]).dot(mesh.vertices[c]) / 6;
    return volume;
}

/// Each directed edge once and its reverse once: closed, edge-manifold, consistently oriented.
inline bool is_closed_and_oriented(const TriangleMesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> directed;
    for (const Face& face : mesh.faces)
        for (std::size_t i = 0; i < 3; ++i)
            if (!directed.insert({face[i], face[(i + 1) % 3]}).second) return false;
    return std::all_of(directed.begin(), directed.end(), [&](const auto& e) {
        return directed.contains({e.second, e.first});
    });
}

/// The faces around every vertex form one closed fan.
inline bool is_vertex_manifold(const TriangleMesh& mesh) {
    std::vector<std::map<std::uint32_t, std::uint32_t>> next(mesh.vertex_count());
    for (const auto& [a, b, c] : mesh.faces) {
        next[a][b] = c;
        next[b][c] = a;
        next[c][a] = b;
    }
    for (const auto& ring : next) {
        if (ring.size() < 3) return false;
        std::size_t steps = 1;
        for (std::uint32_t v = ring.begin()->second; v != ring.begin()->first && steps <= ring.size(); ++steps)
            v = ring.at(v);
        if (steps != ring.size()) return false;
    }
    return true;
}

}  // namespace exemplar
