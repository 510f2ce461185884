#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "host/curvature/model/predictor.h"
#include "host/curvature/model/tiling.h"

namespace exemplar {

/// Collects learned features of inputs, and bases whose components are linear in these features.
class PredictorBuilder {
  public:
    explicit PredictorBuilder(std::size_t input_count);

    /// Appends features; returns the index of the first.
    std::uint32_t add_monomials(std::span<const Monomial> monomials);
    /// Appends neurons (weights: neurons x inputs); returns the feature index of the first. Neurons are numbered
    /// after all monomials, so no monomials may be added later.
    std::uint32_t add_neurons(const Eigen::Ref<const Eigen::MatrixXf>& weights,
                              const Eigen::Ref<const Eigen::VectorXf>& bias);

    /// Adds a basis (vertices x D) of an attribute whose components are z = regression (D x F) times the features
    /// [first_feature, first_feature + F).
    void add_basis(std::size_t attribute, const std::vector<std::uint32_t>& vertices,
                   const Eigen::Ref<const Eigen::MatrixXf>& basis, std::uint32_t first_feature,
                   const Eigen::Ref<const Eigen::MatrixXf>& regression);

    /// Adds components that equal `inputs`; returns the index of the first.
    std::uint32_t add_inputs(std::span<const Monomial> inputs);
    /// Adds a basis of an attribute for existing components, from `first_component` on. Attributes can share them.
    void add_shared_basis(std::size_t attribute, const std::vector<std::uint32_t>& vertices,
                          const Eigen::Ref<const Eigen::MatrixXf>& basis, std::uint32_t first_component);

    const ComponentRegression& regression() const { return regression_; }
    const std::vector<VertexBasis>& bases() const { return bases_; }

  private:
    ComponentRegression regression_;
    std::vector<VertexBasis> bases_;
};

}  // namespace exemplar
