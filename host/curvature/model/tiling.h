#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "host/curvature/model/predictor.h"

namespace exemplar {

/// The bases of one attribute over some vertices, before they are cut into tiles: columns are components of unit
/// variance in training, numbered from first_component.
struct VertexBasis {
    std::size_t attribute = 0;
    std::vector<std::uint32_t> vertices;  ///< rising
    Eigen::MatrixXf basis;                ///< vertices x components
    std::uint32_t first_component = 0;
};

struct TilingOptions {
    /// What sparsity may leave out of each attribute: a share of the variance, in units of `scales` and summed over all
    /// vertices, that the bases explain. 0 keeps every entry that is not zero.
    double dropped_variance = 0;
    /// attributes x vertices: what a deviation is counted in, such as how much the vertex varies; empty: all alike.
    Eigen::MatrixXf scales{};
};

/// Place of each point on a curve that fills space (Morton 1966), over the box of all: points whose places are near
/// each other mostly lie near each other.
std::vector<std::uint32_t> curve_places(std::span<const Vec3> points);

/// Cuts bases into tiles: vertices of a segment are ordered along a space-filling curve over `rest`, so that the
/// sixteen of a tile are neighbors, and where a component is weak in a tile its entry is left out, the weakest first.
/// means: attributes x vertices. Throws UsageError if there are more than 65536 components.
BasisTiles make_tiles(const AttributeFrames& frames, std::span<const Vec3> rest,
                      const Eigen::Ref<const Eigen::MatrixXf>& means, const std::vector<VertexBasis>& bases,
                      const TilingOptions& options);

}  // namespace exemplar
