#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "host/curvature/model/predictor.h"

namespace exemplar {

/// The basis of one attribute over some vertices, before it is cut into tiles. Columns are components with unit
/// variance in training, numbered from first_component.
struct VertexBasis {
    std::size_t attribute = 0;
    std::vector<std::uint32_t> vertices;  ///< ascending
    Eigen::MatrixXf basis;                ///< vertices x components
    std::uint32_t first_component = 0;
};

struct TilingOptions {
    /// Maximum share that is dropped for sparsity, per attribute, of the variance that the bases explain, in units
    /// of `scales` and summed over all vertices. 0 keeps every nonzero entry.
    double dropped_variance = 0;
    /// attributes x vertices: the units of deviations, such as how much the vertex varies; empty: 1 everywhere.
    Eigen::MatrixXf scales{};
};

/// Returns the position of each point on a space-filling curve (Morton 1966) through the bounding box of all points.
/// Points with close positions mostly lie near each other.
std::vector<std::uint32_t> curve_places(std::span<const Vec3> points);

/// Components that a model can number, with 16 bits.
constexpr std::size_t k_max_components = 65536;

/// Cuts bases into tiles. The vertices of a segment are ordered along a space-filling curve through `rest`, so that
/// the sixteen of a tile lie near each other. The weakest entries are dropped as `options` allow. means: attributes
/// x vertices. Throws UsageError if there are more than k_max_components.
BasisTiles make_tiles(const AttributeFrames& frames, std::span<const Vec3> rest,
                      const Eigen::Ref<const Eigen::MatrixXf>& means, const std::vector<VertexBasis>& bases,
                      const TilingOptions& options);

}  // namespace exemplar
