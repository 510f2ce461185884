#include "host/curvature/model/predictor.h"

namespace exemplar {

bool ComponentRegression::is_identity() const {
    const auto one = static_cast<std::uint32_t>(input_count);
    if (components.size() != input_count || monomials.size() < input_count) return false;
    for (std::uint32_t i = 0; i < components.size(); ++i) {
        const auto& [feature, count, coefficient] = components[i];
        if (feature != i || count != 1 || coefficients[coefficient] != 1 || monomials[i] != Monomial{i, one, one})
            return false;
    }
    return true;
}

void ComponentRegression::evaluate(std::span<const float> x, std::span<float> features, std::span<float> z) const {
    const auto input = [&](std::uint32_t i) { return i < x.size() ? x[i] : 1.0f; };
    for (std::size_t m = 0; m < monomials.size(); ++m)
        features[m] = input(monomials[m][0]) * input(monomials[m][1]) * input(monomials[m][2]);
    if (neurons.rows() > 0) {
        const Eigen::Map<const Eigen::VectorXf> in(x.data(), static_cast<Eigen::Index>(x.size()));
        Eigen::Map<Eigen::ArrayXf>(features.data() + monomials.size(), neurons.rows()) =
            (neurons * in + neuron_bias).array().tanh();
    }
    for (std::size_t c = 0; c < components.size(); ++c) {
        const Component& part = components[c];
        z[c] = Eigen::Map<const Eigen::VectorXf>(features.data() + part.first_feature, part.feature_count)
                   .dot(Eigen::Map<const Eigen::VectorXf>(coefficients.data() + part.first_coefficient,
                                                          part.feature_count));
    }
}

std::size_t BasisTiles::bytes() const {
    return vertex.size() * sizeof(vertex[0]) + segment.size() * sizeof(segment[0]) +
           entry_begin.size() * sizeof(entry_begin[0]) + entry.size() * sizeof(entry[0]) + basis.size() +
           (mean.size() + reference.size()) * sizeof(Half) + neighbor.size() * sizeof(neighbor[0]);
}

void reproject(const BasisTiles& tiles, std::span<const float> z, std::span<float> attributes) {
    constexpr std::size_t k_lanes = BasisTiles::k_lanes;
    const std::size_t count = attribute_count(tiles.set);
    for (std::size_t row = 0; row < tiles.tile_count() * count; ++row)
        for (std::size_t lane = 0; lane < k_lanes; ++lane) {
            const std::size_t attribute = row % count, vertex = tiles.vertex[row / count * k_lanes + lane];
            float sum = tiles.scale[attribute] * from_half(tiles.mean[row * k_lanes + lane]);
            for (std::uint32_t e = tiles.entry_begin[row]; e < tiles.entry_begin[row + 1]; ++e)
                sum += BasisTiles::step_of(tiles.entry[e]) * static_cast<float>(tiles.basis[e * k_lanes + lane]) *
                       z[BasisTiles::component_of(tiles.entry[e])];
            attributes[attribute * tiles.vertex_count + vertex] = sum;
        }
}

}  // namespace exemplar
