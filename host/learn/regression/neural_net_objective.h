#pragma once

#include <Eigen/Core>

#include "host/learn/regression/neural_net.h"

namespace exemplar {

/// Eq. 5.16 as a function of all weights in one vector: hidden (L x K), hidden bias, output (D x L), output bias,
/// each column-major.
class NeuralNetObjective {
  public:
    /// x: N x K, z: N x D.
    NeuralNetObjective(Eigen::MatrixXd x, Eigen::MatrixXd z, const NeuralNetOptions& options);

    Eigen::Index size() const { return neurons_ * (x_.cols() + 1) + z_.cols() * (neurons_ + 1); }
    /// Returns the objective at `weights` and writes its gradient; both vectors have size() entries.
    double evaluate(const Eigen::VectorXd& weights, Eigen::VectorXd& gradient);
    /// Returns the initial weights of training: those of thesis Sec. 5.6.1 in units(), and the mean targets as
    /// output bias.
    Eigen::VectorXd start(std::uint64_t seed) const;
    NeuralNet net(const Eigen::VectorXd& weights) const;
    /// Returns the unit of each weight: the outputs' deviation for the output layer, 1 for the hidden layer.
    Eigen::VectorXd units() const;
    /// Returns the scale of the objective: the squared deviation of the outputs times the number of their values.
    double scale() const;

  private:
    Eigen::MatrixXd x_, z_;
    Eigen::Index neurons_;
    double lambda_;
    double deviation_;                       // root mean square of z minus its means, or 1 if it does not vary
    Eigen::MatrixXd active_, error_, back_;  // N x L, N x D, N x L: reused between calls
};

}  // namespace exemplar
