#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>

namespace exemplar {

/// g(x) = sum over l of w_l tanh(b_l . x + b0_l) + w_0 (thesis Eq. 5.15): K inputs, one hidden layer of L neurons and
/// D outputs, which share the hidden layer.
struct NeuralNet {
    Eigen::MatrixXf hidden;       ///< L x K: b
    Eigen::VectorXf hidden_bias;  ///< L: b0
    Eigen::MatrixXf output;       ///< D x L: w
    Eigen::VectorXf output_bias;  ///< D: w_0

    /// z = g(x). Throws UsageError unless x has K and z has D entries.
    void evaluate(std::span<const float> x, std::span<float> z) const;
    /// g of every row of x (N x K): N x D. Throws UsageError for another K.
    Eigen::MatrixXf evaluate(const Eigen::Ref<const Eigen::MatrixXf>& x) const;
};

struct NeuralNetOptions {
    std::size_t neurons = 10;  ///< L, at least 1
    double lambda = 1e-3;      ///< weight decay (Eq. 5.16), at least 0; the biases do not decay
    std::uint64_t seed = 1;    ///< of the initial weights
    int iterations = 5000;     ///< maximum iterations of L-BFGS
};

struct NeuralNetFit {
    NeuralNet net;
    double objective = 0;  ///< Eq. 5.16 at the net
    int iterations = 0;    ///< iterations of L-BFGS that were done
};

/// Minimizes Eq. 5.16, sum over i of ||z_i - g(x_i)||^2 + lambda (||w||^2 + ||b||^2), over rows x_i of x (N x K) and
/// z_i of z (N x D), by L-BFGS in double, from weights uniform over +-1/K (w) and +-1/L (b) as in thesis Sec. 5.6.1.
/// Stops when the objective hardly falls, after options.iterations, or when the line search finds no improvement;
/// returns the best net seen. Inputs should be of order 1, as blending weights are. Uses one thread; the same seed
/// gives the same net. Throws UsageError for sizes and options that do not fit, DataError for values that are not
/// finite.
NeuralNetFit fit_neural_net(const Eigen::Ref<const Eigen::MatrixXf>& x, const Eigen::Ref<const Eigen::MatrixXf>& z,
                            const NeuralNetOptions& options = {});

/// Returns `options` with the candidates for neurons and lambda whose nets predict best in cross-validation: each of
/// `folds` (2 to N) runs of neighboring samples is predicted by a net fitted to the others, on all cores. Among
/// equal errors the first candidates win. Does not depend on the number of threads. Throws UsageError without
/// candidates or for folds out of range, and what fit_neural_net throws.
NeuralNetOptions choose_neural_net(const Eigen::Ref<const Eigen::MatrixXf>& x,
                                   const Eigen::Ref<const Eigen::MatrixXf>& z, std::span<const std::size_t> neurons,
                                   std::span<const double> lambdas, std::size_t folds,
                                   const NeuralNetOptions& options = {});

}  // namespace exemplar
