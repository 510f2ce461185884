#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Gives equal positions one vertex.
class VertexWelder {
  public:
    /// The vertex at `position`, appended to `vertices` if there was none. -0 equals 0.
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

/// The mesh with one vertex per position: the same triangles, and those that touch along an edge share it. A mesh
/// without coincident vertices comes back as it is.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace exemplar
