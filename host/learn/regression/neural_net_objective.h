#pragma once

#include <Eigen/Core>

#include "host/learn/regression/neural_net.h"

namespace exemplar {

/// Eq. 5.16 as a function of all weights in one vector: hidden (L x K), hidden bias, output (D x L), output bias, each
/// by columns.
class NeuralNetObjective {
  public:
    /// x: N x K, z: N x D.
    NeuralNetObjective(Eigen::MatrixXd x, Eigen::MatrixXd z, const NeuralNetOptions& options);

    Eigen::Index size() const { return neurons_ * (x_.cols() + 1) + z_.cols() * (neurons_ + 1); }
    /// The objective at `weights`, and its derivatives into `gradient` (both of size() entries).
    double evaluate(const Eigen::VectorXd& weights, Eigen::VectorXd& gradient);
    /// Weights as training starts from them: thesis Sec. 5.6.1 in units(), and the mean targets as output bias.
    Eigen::VectorXd start(std::uint64_t seed) const;
    NeuralNet net(const Eigen::VectorXd& weights) const;
    /// What each weight is measured in: the outputs' deviation for those of the output, 1 for those of the hidden
    /// layer.
    Eigen::VectorXd units() const;
    /// The outputs' deviation, squared, times their number: what errors are small or large against.
    double scale() const;

  private:
    Eigen::MatrixXd x_, z_;
    Eigen::Index neurons_;
    double lambda_;
    double deviation_;                       // root mean square of z less its means, or 1 if it does not vary
    Eigen::MatrixXd active_, error_, back_;  // N x L, N x D, N x L: kept from call to call
};

}  // namespace exemplar
