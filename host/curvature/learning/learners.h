#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/curvature/learning/influence.h"
#include "host/curvature/learning/model_builder.h"
#include "host/curvature/state/samples.h"
#include "host/curvature/learning/training.h"
#include "host/learn/components/fast_ica.h"

namespace exemplar {

/// What all learners start from.
struct LearningTask {
    const Animation& animation;
    const StateReader& reader;
    const TrainingSamples& samples;
    Eigen::MatrixXf means;               ///< attributes x vertices
    Eigen::MatrixXf scales;              ///< attributes x vertices: what errors are counted in (see TilingOptions)
    std::vector<InfluenceGroup> groups;  ///< after the test; vertices that do not vary have no controls
    const CurvatureTraining& options;

    Eigen::Index poses() const { return samples.states.rows(); }
    /// The training values of an attribute at some vertices, less their means: poses x vertices.
    Eigen::MatrixXf centered(std::size_t attribute, const std::vector<std::uint32_t>& vertices) const;
    /// Bases of an attribute's training values or predictions at some vertices (poses x vertices), as the options ask
    /// for them: of the values in units of `scales`, so that the share of the variance that is kept is kept at every
    /// vertex, and not where the surface bends most alone.
    Ica reduce(const Eigen::Ref<const Eigen::MatrixXf>& values, std::size_t attribute,
               const std::vector<std::uint32_t>& vertices) const;
    /// The vertices that some control matters to, rising.
    std::vector<std::uint32_t> varying_vertices() const;
    /// The bases of each attribute over those vertices.
    std::vector<Ica> reduce_all(const std::vector<std::uint32_t>& vertices) const;
};

// Each adds the bases of all attributes, with their regressions, to the builder.
void learn_additive(const LearningTask& task, PredictorBuilder& builder);
void learn_averaged(const LearningTask& task, PredictorBuilder& builder);
void learn_global(const LearningTask& task, PredictorBuilder& builder);
void learn_network(const LearningTask& task, PredictorBuilder& builder);

/// [1, x, x^2 (, x^3)] of some inputs as monomials (Eqs. 5.3, 5.4).
std::vector<Monomial> polynomial_monomials(std::span<const std::uint32_t> inputs, std::size_t input_count, int degree);
/// Values of monomials: poses x monomials.
Eigen::MatrixXd monomial_values(std::span<const Monomial> monomials, const Eigen::Ref<const Eigen::MatrixXf>& states);
/// The vertices that a control matters to, rising.
std::vector<std::vector<std::uint32_t>> vertices_of_controls(const LearningTask& task);
/// Ridges to choose from, relative to the number of poses.
std::span<const double> ridge_candidates();
/// How many runs of poses are left out in turn to choose between models.
std::size_t validation_blocks(Eigen::Index poses);

}  // namespace exemplar
