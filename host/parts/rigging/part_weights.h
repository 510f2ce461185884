#pragma once

#include "host/mesh/skin.h"
#include "host/parts/rigging/skeleton.h"

namespace exemplar {

/// Most joints that may move a vertex.
constexpr std::size_t k_most_influences = 4;

/// Returns a skin whose bone `j` follows joint `j` of a skeleton. Each part is a heat source of its bone, and the heat
/// spreads over the surface for a moment: w solves (A - div(r^2 grad)) w = A w_0, where w_0 is 1 in the part and A the
/// area per vertex (one implicit step of the heat equation, as in Baran and Popovic 2007, with the parts in place of
/// visible bones). The radius r is that of the nearest boundary of the vertex' part (its length over 2 pi), times
/// `falloff`, but at most a quarter of the part's bone. A vertex is moved only by the bones of the parts around it,
/// their parents and children, at most four; its weights sum to one. `inverse_bind` is filled in.
Skin weights_of_parts(const TriangleMesh& mesh, const PartGraph& graph, const Skeleton& skeleton, double falloff = 0.5);

}  // namespace exemplar
