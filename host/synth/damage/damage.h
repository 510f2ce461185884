#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

/// A mesh damaged on purpose.
struct DamagedMesh {
    TriangleMesh mesh;
    /// For each face the original face that it came from, or the nearest one: so labels can be compared by area.
    std::vector<std::uint32_t> origin;
};

/// A kind of damage found in meshes from any source, or a change that should not affect any result.
struct Damage {
    std::string_view name;  ///< as typed on a command line, e.g. "flipped-faces"
    std::string_view what;  ///< description in one line
    /// Damages a usable mesh (see require_usable) of any size; the same seed gives the same mesh. The result is
    /// usable.
    DamagedMesh (*apply)(const TriangleMesh& mesh, std::uint64_t seed);
};

/// Returns all damages, in the order in which tables show them. They treat polygons of the original as triangles;
/// only the result of "quads" has polygons.
std::span<const Damage> damages();
/// Returns the damage with this name. Throws UsageError, with the nearest name, if there is none.
const Damage& damage_named(std::string_view name);

}  // namespace exemplar
