#pragma once

#include <span>

#include "host/labeling/features/features.h"

namespace exemplar {

/// Computes pairwise contextual features (thesis App. A.2e): for each edge and logarithmic distance range, the
/// length-weighted sum of P(boundary) over the edges in that range, divided by the total length of all edges near it.
/// The division makes meshes of different resolution comparable. `boundary_probability` has one value per edge; `out`
/// is k_bins x edges, feature-major.
void accumulate_edge_context(const MeshFeatures& features, std::span<const float> boundary_probability,
                             std::span<float> out);

}  // namespace exemplar
