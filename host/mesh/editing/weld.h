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

/// The rounding that `welded` allows in a coordinate, in float epsilons (2^-23) times the largest absolute coordinate
/// of a face: each of two vertices may err by two units in the last place, as a matrix product in floats does.
constexpr double k_weld_roundings = 4;

/// Returns the mesh with one vertex per position: the same triangles, and those that touch along an edge share it.
/// Two positions are one if no coordinate differs by more than rounding (k_weld_roundings), nor by more than a
/// thousandth (1/1024) of the longest edge of any face around either. So a face never becomes a point, however far
/// other faces are away; the ends of an edge are joined only where they make its faces needles. The first vertex at a
/// place is kept. A mesh without coincident vertices is returned unchanged.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace exemplar
