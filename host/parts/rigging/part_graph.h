#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

/// A connected piece of one label.
struct Part {
    std::int32_t label = 0;
    double area = 0;  ///< in squared mesh units
    Vec3 center;      ///< area centroid
};

/// Where two parts touch, or, if they are pieces that no edge connects, where they are nearest to each other.
struct PartBoundary {
    std::array<std::uint32_t, 2> part;  ///< part[0] < part[1]
    double length = 0;                  ///< of the edges between them, in mesh units; 0 if no edge connects them
    double strength = 0;                ///< the length of its edges, less where they are concave creases
    Vec3 center;                        ///< length-weighted centroid of the longest connected boundaries, see below
};

/// The parts of a mesh and how they are connected.
struct PartGraph {
    std::vector<std::uint32_t> part_of_face;
    std::vector<Part> parts;
    std::vector<PartBoundary> boundaries;  ///< at most one per pair of parts, sorted by the pair; connects all parts
};

/// Pieces smaller than this share of the largest piece of their label are slivers, and so are unlabeled pieces.
constexpr double k_sliver_share = 0.1;

/// Divides a mesh into its connected pieces of equal label. Slivers are merged into the neighbor
/// with the longest common boundary. Each component but the largest is connected to the nearest of the larger ones; the
/// piece there is merged if it is a sliver or has the same label. If two parts touch along several connected
/// boundaries, the center is that of those at least half as long as the longest, so that a spot where an arm touches
/// the hip does not count. Two things of one label that touch each other are divided (see divide_joined_parts).
/// `topology` is that of `mesh`. Throws UsageError if there is not one label per face.
PartGraph build_part_graph(const TriangleMesh& mesh, const Topology& topology, std::span<const std::int32_t> label,
                           double sliver_share = k_sliver_share);

}  // namespace exemplar
