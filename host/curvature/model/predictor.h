#pragma once

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host/core/half.h"
#include "host/curvature/state/attributes.h"

namespace exemplar {

/// A product of up to three inputs; the index input_count stands for the constant 1.
using Monomial = std::array<std::uint32_t, 3>;

/// Maps the inputs x to the components z of all attributes: each z_c is a linear combination of features. Features
/// are first monomials of x (Eqs. 5.3, 5.4), then neurons tanh(b . x + b0) (Eq. 5.15).
struct ComponentRegression {
    std::size_t input_count = 0;
    std::vector<Monomial> monomials;
    Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> neurons;  ///< neurons x inputs
    Eigen::VectorXf neuron_bias;
    struct Component {
        std::uint32_t first_feature, feature_count, first_coefficient;
    };
    std::vector<Component> components;
    std::vector<float> coefficients;

    /// Returns whether the components are exactly the inputs in order, as for local shape.
    bool is_identity() const;
    std::size_t feature_count() const { return monomials.size() + static_cast<std::size_t>(neurons.rows()); }
    /// Computes z, components.size() numbers. features: work space of feature_count() numbers.
    void evaluate(std::span<const float> x, std::span<float> features, std::span<float> z) const;
};

/// The bases W and means of all attributes (Eq. 5.10: y = sum_j w_j W_j z_j + mean; the weights w are multiplied
/// into the bases). Vertices are grouped into tiles of k_lanes neighbors of one segment; a tile lists only the
/// components that matter in it. Means are half floats. The basis of a component in a tile is sixteen signed bytes,
/// with a step of 1/127 of the largest magnitude or slightly more.
struct BasisTiles {
    static constexpr std::size_t k_lanes = 16;
    AttributeSet set = AttributeSet::tensor;
    std::size_t vertex_count = 0;
    std::vector<std::uint32_t> vertex;   ///< per lane; the last tile of a segment may repeat its last vertex
    std::vector<std::uint32_t> segment;  ///< per tile; 0 if there are no segments
    std::vector<float> scale;            ///< per attribute: factor of its means
    /// Attribute a of tile t has the entries [entry_begin[i], entry_begin[i + 1]) with i = t * attributes + a.
    std::vector<std::uint32_t> entry_begin;
    std::vector<std::uint32_t> entry;     ///< see component_of and step_of
    std::vector<std::int8_t> basis;       ///< entries x k_lanes, in steps
    std::vector<Half> mean;               ///< tiles x attributes x k_lanes
    std::vector<std::uint32_t> neighbor;  ///< tensor, per lane: see AttributeFrames
    std::vector<Half> reference;          ///< principal: tiles x 3 x k_lanes: reference normals (see AttributeFrames)

    /// An entry packs its component (lower 16 bits) and the upper 16 bits of its step as a float.
    static std::uint32_t component_of(std::uint32_t entry) { return entry & 0xFFFFu; }
    static float step_of(std::uint32_t entry) { return std::bit_cast<float>(entry & 0xFFFF0000u); }
    /// Returns an entry whose step is min_step (>= 0), rounded up by at most 1/128 of it.
    static std::uint32_t make_entry(std::uint16_t component, float min_step) {
        return ((std::bit_cast<std::uint32_t>(min_step) + 0xFFFFu) & 0xFFFF0000u) | component;
    }
    std::size_t tile_count() const { return segment.size(); }
    std::size_t bytes() const;
};

/// Computes the attributes of all vertices, attribute-major (attributes x vertices). Reference of
/// reproject_curvature.
void reproject(const BasisTiles& tiles, std::span<const float> z, std::span<float> attributes);

/// Does what reproject and AttributeFrames::decode do, in one fast pass over the tiles. Every frame runs it.
void reproject_curvature(const BasisTiles& tiles, std::span<const float> z, const PosedSurface& surface,
                         VertexCurvature& curvature);

}  // namespace exemplar
