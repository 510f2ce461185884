#include "host/curvature/learning/model_builder.h"

namespace exemplar {

PredictorBuilder::PredictorBuilder(std::size_t input_count) {
    regression_.input_count = input_count;
    regression_.neurons.resize(0, static_cast<Eigen::Index>(input_count));
}

std::uint32_t PredictorBuilder::add_monomials(std::span<const Monomial> monomials) {
    const auto first = static_cast<std::uint32_t>(regression_.monomials.size());
    regression_.monomials.insert(regression_.monomials.end(), monomials.begin(), monomials.end());
    return first;
}

std::uint32_t PredictorBuilder::add_neurons(const Eigen::Ref<const Eigen::MatrixXf>& weights,
                                            const Eigen::Ref<const Eigen::VectorXf>& bias) {
    const auto first = static_cast<std::uint32_t>(regression_.feature_count());
    const Eigen::Index before = regression_.neurons.rows();
    regression_.neurons.conservativeResize(before + weights.rows(), Eigen::NoChange);
    regression_.neurons.bottomRows(weights.rows()) = weights;
    regression_.neuron_bias.conservativeResize(before + bias.size());
    regression_.neuron_bias.tail(bias.size()) = bias;
    return first;
}

void PredictorBuilder::add_basis(std::size_t attribute, const std::vector<std::uint32_t>& vertices,
                                 const Eigen::Ref<const Eigen::MatrixXf>& basis, std::uint32_t first_feature,
                                 const Eigen::Ref<const Eigen::MatrixXf>& regression) {
    if (basis.cols() == 0) return;
    bases_.push_back({attribute, vertices, basis, static_cast<std::uint32_t>(regression_.components.size())});
    for (Eigen::Index d = 0; d < regression.rows(); ++d) {
        regression_.components.push_back({first_feature, static_cast<std::uint32_t>(regression.cols()),
                                          static_cast<std::uint32_t>(regression_.coefficients.size())});
        for (Eigen::Index f = 0; f < regression.cols(); ++f) regression_.coefficients.push_back(regression(d, f));
    }
}

std::uint32_t PredictorBuilder::add_inputs(std::span<const Monomial> inputs) {
    const std::uint32_t feature = add_monomials(inputs);
    const auto first = static_cast<std::uint32_t>(regression_.components.size());
    for (std::uint32_t i = 0; i < inputs.size(); ++i) {
        regression_.components.push_back({feature + i, 1, static_cast<std::uint32_t>(regression_.coefficients.size())});
        regression_.coefficients.push_back(1);
    }
    return first;
}

void PredictorBuilder::add_shared_basis(std::size_t attribute, const std::vector<std::uint32_t>& vertices,
                                        const Eigen::Ref<const Eigen::MatrixXf>& basis, std::uint32_t first_component) {
    if (basis.cols() > 0) bases_.push_back({attribute, vertices, basis, first_component});
}

}  // namespace exemplar
