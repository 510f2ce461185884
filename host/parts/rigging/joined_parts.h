#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// A part is cut if the cut is shorter than this many times the boundaries that it separates.
constexpr double k_joined_cut_ratio = 1.35;

/// Divides parts that are two things of one label which touch each other: two upper legs that meet in the crotch. Such
/// a part has two neighbors of one label (the lower legs) with about equal boundaries, and no other pair of neighbors.
/// The shortest cut between the two is looked for where the part is about as far from both (a minimum cut over the
/// edges of the mesh; faces twice as near to one as to the other are on its side). The part is divided if the cut is
/// short beside the two boundaries, and if these are long beside the size of the halves, as the ends of limbs are: a
/// head between two ears stays whole. `label_of_part` grows with the new parts, which are numbered after the others.
void divide_joined_parts(const TriangleMesh& mesh, const Topology& topology, std::vector<std::int32_t>& label_of_part,
                         std::vector<std::uint32_t>& part_of_face);

}  // namespace exemplar
