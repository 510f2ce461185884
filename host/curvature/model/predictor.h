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

/// A product of up to three inputs; the index input_count stands for one.
using Monomial = std::array<std::uint32_t, 3>;

/// From the inputs x to the components z of all attributes: z_c = sum of coefficients times features, the features
/// being monomials of x (Eqs. 5.3, 5.4) and then neurons tanh(b . x + b0) (Eq. 5.15).
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

    /// Whether the components are the inputs, one by one, as a linear map of local shape has them.
    bool copies_inputs() const;
    std::size_t feature_count() const { return monomials.size() + static_cast<std::size_t>(neurons.rows()); }
    /// features: feature_count() numbers of work space; z: components.size() numbers.
    void evaluate(std::span<const float> x, std::span<float> features, std::span<float> z) const;
};

/// The bases W and means of all attributes (Eq. 5.10: y = sum_j w_j W_j z_j + mean, the weights w multiplied into the
/// bases). Vertices stand in tiles of k_lanes that lie side by side on the surface and belong to one segment; a tile
/// lists only the components that matter there. Means are halves; a basis at the lanes of a tile is sixteen bytes, in
/// steps of a 127th of the largest or a little more.
struct BasisTiles {
    static constexpr std::size_t k_lanes = 16;
    AttributeSet set = AttributeSet::tensor;
    std::size_t vertex_count = 0;
    std::vector<std::uint32_t> vertex;   ///< of each lane; those of the last tile of a segment may repeat a vertex
    std::vector<std::uint32_t> segment;  ///< of each tile; 0 where attributes need no segments
    std::vector<float> scale;            ///< of each attribute: what its means are multiplied with
    /// The entries of attribute a of tile t: entry_begin[t * attributes + a] to the next.
    std::vector<std::uint32_t> entry_begin;
    std::vector<std::uint32_t> entry;     ///< see component_of and step_of
    std::vector<std::int8_t> basis;       ///< entries x k_lanes, in steps
    std::vector<Half> mean;               ///< tiles x attributes x k_lanes
    std::vector<std::uint32_t> neighbor;  ///< tensor, of each lane: see AttributeFrames
    std::vector<Half> reference;          ///< principal: tiles x 3 x k_lanes: reference normals (see AttributeFrames)

    /// An entry is the number of its component, and above it the upper half of the float that is its step.
    static std::uint32_t component_of(std::uint32_t entry) { return entry & 0xFFFFu; }
    static float step_of(std::uint32_t entry) { return std::bit_cast<float>(entry & 0xFFFF0000u); }
    /// With a step of at least `least_step` and at most a 128th more; least_step >= 0.
    static std::uint32_t make_entry(std::uint16_t component, float least_step) {
        return ((std::bit_cast<std::uint32_t>(least_step) + 0xFFFFu) & 0xFFFF0000u) | component;
    }
    std::size_t tile_count() const { return segment.size(); }
    std::size_t bytes() const;
};

/// Attributes of all vertices, attribute-major (attributes x vertices).
void reproject(const BasisTiles& tiles, std::span<const float> z, std::span<float> attributes);

/// Re-projection and AttributeFrames::decode in one pass over the tiles, which is what a frame runs.
void reproject_curvature(const BasisTiles& tiles, std::span<const float> z, const PosedSurface& surface,
                         VertexCurvature& curvature);

}  // namespace exemplar
