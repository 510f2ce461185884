#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host/mesh/mesh.h"

namespace exemplar {

struct TransferOptions {
    /// Weight of the length of borders between labels; 0 lets each face decide alone.
    float smoothness = 0.3F;
};

struct TransferredLabels {
    std::vector<std::int32_t> label;  ///< per triangle of the target, -1 where the source is unlabeled
    /// Per triangle the share of votes for its label, in [0, 1]; 0 where the source is farther away than 2 % of its
    /// diagonal, or no surface near there faces the same way.
    std::vector<float> confidence;
    double sure_share = 0;       ///< share of the target's area with a confidence above 0.8
    double median_distance = 0;  ///< of points of the target to the source, mesh units
};

/// Transfers labels (`label`: per triangle of `source`, -1 for none) to `target`, which has about the same shape in the
/// same place. Points of each target face are given votes by the nearest points of the source, weighted by distance and
/// by the agreement of the normals, n . n' cut off at 0. The label of a face minimizes the sum of -log(share of votes)
/// times its area and of the lengths of borders, which cost less along bends (alpha expansion, Boykov et al. 2001).
/// Throws UsageError for a number of labels other than of faces, MeshError if a mesh has no faces.
TransferredLabels transfer_labels(const TriangleMesh& source, std::span<const std::int32_t> label,
                                  const TriangleMesh& target, const TransferOptions& options = {});

}  // namespace exemplar
