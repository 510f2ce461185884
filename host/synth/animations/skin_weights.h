#pragma once

#include <cstdint>
#include <span>

#include "host/animation/animation.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// The straight center line of the part of a body that a bone moves.
struct BoneSegment {
    Vec3 begin, end;
};

/// Computes skinning weights by heat diffusion over the surface (after Baran and Popovic 2007, but applied twice,
/// for continuous second derivatives). Each vertex is heated by the bone it belongs to (`bone_of_vertex`), the more
/// the nearer it is. At most four influences per vertex, which sum to one. Fills influence_begin and influences.
/// Throws MeshError if the equilibrium cannot be computed.
void set_skin_weights(Rig& rig, const TriangleMesh& mesh, std::span<const BoneSegment> bones,
                      std::span<const std::uint32_t> bone_of_vertex);

}  // namespace exemplar
