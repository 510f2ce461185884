#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Merges equal positions into one vertex.
class VertexWelder {
  public:
    /// Returns the vertex at `position`; appends it to `vertices` if it is new. -0 equals 0.
    std::uint32_t add(const Vec3& position, std::vector<Vec3>& vertices);

  private:
    struct Key {
        std::array<std::uint32_t, 3> bits;
        bool operator==(const Key&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Key& key) const;
    };
    std::unordered_map<Key, std::uint32_t, Hash> index_;
};

/// Returns the mesh with one vertex per position: the same triangles, and those that touch along an edge share it. A
/// mesh without coincident vertices is returned unchanged.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace exemplar
