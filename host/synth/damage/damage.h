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
    /// For each face the face of the original that it came from, or the nearest one: labels can be compared by area.
    std::vector<std::uint32_t> origin;
};

/// A kind of damage that meshes come with, whoever made them, or a change that should not matter to anybody.
struct Damage {
    std::string_view name;  ///< as typed on a command line, e.g. "flipped-faces"
    std::string_view what;  ///< what is done, in a line
    /// Damages a usable mesh (see require_usable) of any size; the same seed gives the same mesh. The result is usable.
    DamagedMesh (*apply)(const TriangleMesh& mesh, std::uint64_t seed);
};

/// All damages, in the order in which tables show them. Polygons of the original are taken as their triangles; of the
/// results only those of "quads" have polygons.
std::span<const Damage> damages();
/// The damage of this name. Throws UsageError, with the nearest one, if there is none.
const Damage& damage_named(std::string_view name);

}  // namespace exemplar
