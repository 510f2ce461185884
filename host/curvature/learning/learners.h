#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/curvature/learning/influence.h"
#include "host/curvature/learning/model_builder.h"
#include "host/curvature/learning/training.h"
#include "host/curvature/state/samples.h"
#include "host/learn/components/fast_ica.h"

namespace exemplar {

/// The input of all learners.
struct LearningTask {
    const Animation& animation;
    const StateReader& reader;
    const TrainingSamples& samples;
    Eigen::MatrixXf means;               ///< attributes x vertices
    Eigen::MatrixXf scales;              ///< attributes x vertices: units of errors (see TilingOptions)
    std::vector<InfluenceGroup> groups;  ///< after the F-test; vertices that do not vary have no controls
    const CurvatureTraining& options;

    Eigen::Index poses() const { return samples.states.rows(); }
    /// Returns the training values of an attribute at some vertices minus their means: poses x vertices.
    Eigen::MatrixXf centered(std::size_t attribute, const std::vector<std::uint32_t>& vertices) const;
    /// Computes ICA or PCA bases, as the options say, of an attribute's values at some vertices (poses x vertices).
    /// Values are measured in units of `scales`, so that the share of variance is kept at every vertex rather than
    /// only where the surface bends most.
    Ica reduce(const Eigen::Ref<const Eigen::MatrixXf>& values, std::size_t attribute,
               const std::vector<std::uint32_t>& vertices) const;
    /// Returns the vertices that some control influences, ascending.
    std::vector<std::uint32_t> varying_vertices() const;
    /// Computes the bases of each attribute over those vertices.
    std::vector<Ica> reduce_all(const std::vector<std::uint32_t>& vertices) const;
};

// Each learner adds the bases of all attributes, with their regressions, to the builder (see Learner).
void learn_additive(const LearningTask& task, PredictorBuilder& builder);
void learn_averaged(const LearningTask& task, PredictorBuilder& builder);
void learn_global(const LearningTask& task, PredictorBuilder& builder);
void learn_network(const LearningTask& task, PredictorBuilder& builder);

/// Returns [1, x, x^2 (, x^3)] of some inputs as monomials (Eqs. 5.3, 5.4).
std::vector<Monomial> polynomial_monomials(std::span<const std::uint32_t> inputs, std::size_t input_count, int degree);
/// Computes the values of monomials: poses x monomials.
Eigen::MatrixXd monomial_values(std::span<const Monomial> monomials, const Eigen::Ref<const Eigen::MatrixXf>& states);
/// Returns for each control the vertices it influences, ascending.
std::vector<std::vector<std::uint32_t>> vertices_of_controls(const LearningTask& task);
/// Returns the candidates of the ridge, relative to the number of poses.
std::span<const double> ridge_candidates();
/// Returns the number of blocks of consecutive poses for cross-validation.
std::size_t validation_blocks(Eigen::Index poses);

}  // namespace exemplar
