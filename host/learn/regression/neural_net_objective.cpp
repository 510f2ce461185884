#include "host/learn/regression/neural_net_objective.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/core/random.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The parts of the vector of all weights; Scalar is double, or const double.
template <typename Matrix, typename Vector, typename Scalar>
struct Parts {
    Eigen::Map<Matrix> hidden;
    Eigen::Map<Vector> hidden_bias;
    Eigen::Map<Matrix> output;
    Eigen::Map<Vector> output_bias;

    Parts(Scalar* data, Index inputs, Index neurons, Index outputs)
        : hidden(data, neurons, inputs),
          hidden_bias(data + hidden.size(), neurons),
          output(data + hidden.size() + neurons, outputs, neurons),
          output_bias(data + hidden.size() + neurons + output.size(), outputs) {}
};
using Weights = Parts<const MatrixXd, const VectorXd, const double>;
using Gradient = Parts<MatrixXd, VectorXd, double>;

double deviation_of(const MatrixXd& z) {
    const double deviation = (z.rowwise() - z.colwise().mean()).norm() / std::sqrt(static_cast<double>(z.size()));
    return deviation > 0 ? deviation : 1.0;
}

}  // namespace

NeuralNetObjective::NeuralNetObjective(MatrixXd x, MatrixXd z, const NeuralNetOptions& options)
    : x_(std::move(x)),
      z_(std::move(z)),
      neurons_(static_cast<Index>(options.neurons)),
      lambda_(options.lambda),
      deviation_(deviation_of(z_)) {}

double NeuralNetObjective::evaluate(const VectorXd& weights, VectorXd& gradient) {
    const Weights at(weights.data(), x_.cols(), neurons_, z_.cols());
    active_.noalias() = x_ * at.hidden.transpose();
    active_.rowwise() += at.hidden_bias.transpose();
    active_.array() = 1.0 - 2.0 / ((2.0 * active_.array()).exp() + 1.0);  // tanh, several at a time
    error_.noalias() = active_ * at.output.transpose();
    error_ -= z_;
    error_.rowwise() += at.output_bias.transpose();

    gradient.resize(size());
    Gradient out(gradient.data(), x_.cols(), neurons_, z_.cols());
    out.output.noalias() = 2.0 * error_.transpose() * active_;
    out.output += 2.0 * lambda_ * at.output;
    out.output_bias = 2.0 * error_.colwise().sum().transpose();
    back_.noalias() = 2.0 * error_ * at.output;
    back_.array() *= 1.0 - active_.array().square();
    out.hidden.noalias() = back_.transpose() * x_;
    out.hidden += 2.0 * lambda_ * at.hidden;
    out.hidden_bias = back_.colwise().sum().transpose();
    return error_.squaredNorm() + lambda_ * (at.output.squaredNorm() + at.hidden.squaredNorm());
}

VectorXd NeuralNetObjective::start(std::uint64_t seed) const {
    Random random(seed);
    const double output_range = deviation_ / static_cast<double>(std::max<Index>(x_.cols(), 1));
    const double hidden_range = 1.0 / static_cast<double>(neurons_);
    VectorXd weights(size());
    Gradient at(weights.data(), x_.cols(), neurons_, z_.cols());
    for (double& weight : at.hidden.reshaped()) weight = random.uniform(-hidden_range, hidden_range);
    for (double& weight : at.hidden_bias) weight = random.uniform(-hidden_range, hidden_range);
    for (double& weight : at.output.reshaped()) weight = random.uniform(-output_range, output_range);
    at.output_bias = z_.colwise().mean().transpose();
    return weights;
}

NeuralNet NeuralNetObjective::net(const VectorXd& weights) const {
    const Weights at(weights.data(), x_.cols(), neurons_, z_.cols());
    return {at.hidden.cast<float>(), at.hidden_bias.cast<float>(), at.output.cast<float>(),
            at.output_bias.cast<float>()};
}

VectorXd NeuralNetObjective::units() const {
    VectorXd out(size());
    out.head(neurons_ * (x_.cols() + 1)).setOnes();
    out.tail(z_.cols() * (neurons_ + 1)).setConstant(deviation_);
    return out;
}

double NeuralNetObjective::scale() const {
    return deviation_ * deviation_ * static_cast<double>(std::max<Index>(z_.size(), 1));
}

}  // namespace exemplar
