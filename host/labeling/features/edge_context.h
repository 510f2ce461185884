#pragma once

#include <span>

#include "host/labeling/features/features.h"

namespace exemplar {

/// Pairwise contextual features (thesis App. A.2e): for each edge and logarithmic distance range the length-weighted
/// sum of P(boundary) over the edges in it, divided by the length of all edges in range, so that meshes of different
/// resolution compare. `boundary_probability` has one value per edge; `out` is k_bins x edges, feature-major.
void accumulate_edge_context(const MeshFeatures& features, std::span<const float> boundary_probability,
                             std::span<float> out);

}  // namespace exemplar
