#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host/parts/rigging/part_graph.h"

namespace exemplar {

/// Two parts or pieces, the smaller number first.
using PartPair = std::pair<std::uint32_t, std::uint32_t>;

/// Returns the length of all edges between the faces of two parts, for each pair that has one.
std::map<PartPair, double> common_lengths(const TriangleMesh& mesh, const Topology& topology,
                                          std::span<const std::uint32_t> part_of_face);

/// Returns a boundary per pair of parts that an edge or a contact connects, sorted by the pair (see build_part_graph).
std::vector<PartBoundary> part_boundaries(const TriangleMesh& mesh, const Topology& topology,
                                          std::span<const std::uint32_t> part_of_face,
                                          std::span<const PartBoundary> contacts);

}  // namespace exemplar
