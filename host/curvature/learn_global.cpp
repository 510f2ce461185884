// Learners that see the surface as a whole: a polynomial of all inputs (cloth, Sec. 5.5.2) or one hidden layer
// (faces, Sec. 5.6.1), to the components of each attribute.

#include <algorithm>
#include <numeric>

#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/curvature/learners.h"
#include "host/learn/least_squares.h"
#include "host/learn/neural_net.h"

namespace exemplar {

namespace {

std::vector<std::uint32_t> varying_vertices(const LearningTask& task) {
    std::vector<std::uint32_t> vertices;
    for (const InfluenceGroup& group : task.groups)
        if (!group.controls.empty()) vertices.insert(vertices.end(), group.vertices.begin(), group.vertices.end());
    std::sort(vertices.begin(), vertices.end());
    return vertices;
}

/// A polynomial and its ridge, chosen by leaving out runs of poses.
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

std::vector<Ica> reduce_all(const LearningTask& task, const std::vector<std::uint32_t>& vertices) {
    std::vector<Ica> bases(task.samples.attributes.size());
    Progress progress("reducing", bases.size());
    parallel_for(bases.size(), [&](std::size_t a) {
        bases[a] = task.reduce(task.centered(a, vertices));
        progress.advance();
    });
    return bases;
}

}  // namespace

void learn_global(const LearningTask& task, PredictorBuilder& builder) {
    const std::vector<std::uint32_t> vertices = varying_vertices(task);
    std::vector<std::uint32_t> inputs(task.reader.input_count);
    std::iota(inputs.begin(), inputs.end(), 0u);
    const std::vector<Monomial> cubic = polynomial_monomials(inputs, task.reader.input_count, 3);
    const std::uint32_t first = builder.add_monomials(cubic);
    const std::vector<Ica> bases = reduce_all(task, vertices);
    for (std::size_t a = 0; a < bases.size(); ++a) {
        if (bases[a].mixing.cols() == 0) continue;
        // In the units of the attribute, as that is what errors count in.
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

void learn_network(const LearningTask& task, PredictorBuilder& builder) {
    constexpr std::array<std::size_t, 3> k_neurons{5, 10, 20};
    constexpr std::array<double, 4> k_lambdas{1e-4, 1e-3, 1e-2, 1e-1};
    const std::vector<std::uint32_t> vertices = varying_vertices(task);
    const std::vector<Ica> bases = reduce_all(task, vertices);
    Progress progress("training networks", bases.size());
    std::vector<NeuralNet> nets(bases.size());
    parallel_for(bases.size(), [&](std::size_t a) {
        if (bases[a].mixing.cols() == 0) return;
        NeuralNetOptions options{.seed = task.options.seed};
        options = choose_neural_net(task.samples.states, bases[a].sources, k_neurons, k_lambdas,
                                    validation_blocks(task.poses()), options);
        nets[a] = fit_neural_net(task.samples.states, bases[a].sources, options).net;
        progress.advance();
    });
    for (std::size_t a = 0; a < bases.size(); ++a) {
        if (bases[a].mixing.cols() == 0) continue;
        const Eigen::Index neurons = nets[a].hidden.rows();
        Eigen::MatrixXf hidden = Eigen::MatrixXf::Zero(neurons + 1, nets[a].hidden.cols());
        hidden.bottomRows(neurons) = nets[a].hidden;
        Eigen::VectorXf bias(neurons + 1);
        bias << 20.0f, nets[a].hidden_bias;  // tanh(20) is one: the constant w_0 stands with its neurons
        Eigen::MatrixXf regression(nets[a].output.rows(), neurons + 1);
        regression << nets[a].output_bias, nets[a].output;
        builder.add_basis(a, vertices, bases[a].mixing, builder.add_neurons(hidden, bias), regression);
    }
}

}  // namespace exemplar
