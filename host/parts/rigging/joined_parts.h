#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// A cut through a part is made if it is shorter than this share of the boundaries that it separates.
constexpr double k_joined_cut_share = 0.6;

/// Divides parts that are two things of one label which touch each other: two upper legs that meet in the crotch. Such
/// a part has several neighbors of one label, and the shortest cut (a minimum cut over the edges of the mesh) between
/// one of them and the others is short beside the boundaries with them. A torso between two arms stays whole, as the
/// cut between them is longer. `label_of_part` grows with the new parts, which are numbered after the others.
void divide_joined_parts(const TriangleMesh& mesh, const Topology& topology, std::vector<std::int32_t>& label_of_part,
                         std::vector<std::uint32_t>& part_of_face);

}  // namespace exemplar
