// The thesis' method for cloth (Sec. 5.5.2): a polynomial of all inputs to the components of each attribute.

#include <algorithm>
#include <numeric>

#include "host/curvature/learning/learners.h"
#include "host/learn/regression/least_squares.h"

namespace exemplar {

namespace {

/// A polynomial and its ridge, chosen by cross-validation over blocks of poses.
struct Polynomial {
    int degree = 1;
    double ridge = 0;
};

Polynomial choose_polynomial(const LearningTask& task, std::span<const std::uint32_t> inputs, int highest,
                             const Eigen::MatrixXd& targets) {
    Polynomial best;
    double least = std::numeric_limits<double>::infinity();
    for (int degree = 1; degree <= highest; ++degree) {
        const Eigen::MatrixXd features =
            monomial_values(polynomial_monomials(inputs, task.reader.input_count, degree), task.samples.states);
        const RidgeChoice choice =
            leave_blocks_out(features, targets, ridge_candidates(), validation_blocks(task.poses()));
        if (choice.error < least) {
            least = choice.error;
            best = {degree, choice.ridge};
        }
    }
    return best;
}

}  // namespace

void learn_global(const LearningTask& task, PredictorBuilder& builder) {
    const std::vector<std::uint32_t> vertices = task.varying_vertices();
    std::vector<std::uint32_t> inputs(task.reader.input_count);
    std::iota(inputs.begin(), inputs.end(), 0u);
    const std::vector<Monomial> cubic = polynomial_monomials(inputs, task.reader.input_count, 3);
    const std::uint32_t first = builder.add_monomials(cubic);
    const std::vector<Ica> bases = task.reduce_all(vertices);
    for (std::size_t a = 0; a < bases.size(); ++a) {
        if (bases[a].mixing.cols() == 0) continue;
        // In the units of the attribute, so that strong components weigh more.
        const Eigen::MatrixXd targets =
            bases[a].sources.cast<double>() * bases[a].mixing.cast<double>().colwise().norm().asDiagonal();
        const Polynomial choice =
            choose_polynomial(task, inputs, is_derivative(task.options.attributes, a) ? 3 : 2, targets);
        const Eigen::MatrixXd features =
            monomial_values(polynomial_monomials(inputs, task.reader.input_count, choice.degree), task.samples.states);
        const Eigen::MatrixXf regression =
            LeastSquares(features, choice.ridge).solve(bases[a].sources.cast<double>()).transpose().cast<float>();
        builder.add_basis(a, vertices, bases[a].mixing, first, regression);
    }
}

}  // namespace exemplar
