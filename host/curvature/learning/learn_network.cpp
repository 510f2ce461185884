// The thesis' method for faces (Sec. 5.6.1): one hidden layer from all inputs to the components of each attribute.

#include <array>

#include "host/core/parallel.h"
#include "host/core/progress.h"
#include "host/curvature/learning/learners.h"
#include "host/learn/regression/neural_net.h"

namespace exemplar {

void learn_network(const LearningTask& task, PredictorBuilder& builder) {
    constexpr std::array<std::size_t, 3> k_neurons{5, 10, 20};
    constexpr std::array<double, 4> k_lambdas{1e-4, 1e-3, 1e-2, 1e-1};
    const std::vector<std::uint32_t> vertices = task.varying_vertices();
    const std::vector<Ica> bases = task.reduce_all(vertices);
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
        bias << 20.0f, nets[a].hidden_bias;  // tanh(20) is 1: a constant neuron carries w_0
        Eigen::MatrixXf regression(nets[a].output.rows(), neurons + 1);
        regression << nets[a].output_bias, nets[a].output;
        builder.add_basis(a, vertices, bases[a].mixing, builder.add_neurons(hidden, bias), regression);
    }
}

}  // namespace exemplar
