#include "host/learn/regression/neural_net.h"

#include <LBFGS.h>
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/parallel.h"
#include "host/learn/regression/neural_net_objective.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;
using FloatRef = Eigen::Ref<const MatrixXf>;

void check_finite_data(const FloatRef& values, const char* what) {
    if (values.allFinite()) return;
    for (Index i = 0; i < values.rows(); ++i) {
        if (values.row(i).allFinite()) continue;
        throw DataError(fmt::format("an {} of sample {} is not finite; leave the sample out", what, i));
    }
}

void check_data(const FloatRef& x, const FloatRef& z) {
    if (x.rows() == 0 || x.rows() != z.rows()) {
        throw UsageError(
            fmt::format("there are {} samples of inputs and {} of outputs; give as many of both, at least one",
                        x.rows(), z.rows()));
    }
    check_finite_data(x, "input");
    check_finite_data(z, "output");
}

void check_net_options(const NeuralNetOptions& options) {
    if (options.neurons < 1) throw UsageError("a neural net needs at least one neuron");
    if (options.iterations < 1) throw UsageError("training a neural net takes at least one iteration");
    if (!(options.lambda >= 0 && std::isfinite(options.lambda))) {
        throw UsageError(fmt::format("a lambda of {} is not a number from 0 up", options.lambda));
    }
}

/// The objective divided by its scale, as a function of the weights in their units, so that the size of the outputs
/// does not matter. Remembers the best weights seen.
struct Descent {
    NeuralNetObjective& objective;
    double scale;
    VectorXd units;
    VectorXd best;
    double least = std::numeric_limits<double>::infinity();
    int iterations = 0;

    double operator()(const VectorXd& weights, VectorXd& gradient) {
        const double value = objective.evaluate(weights.cwiseProduct(units), gradient) / scale;
        gradient = gradient.cwiseProduct(units) / scale;
        if (value < least) least = value, best = weights;
        return value;
    }
};

/// The line search of Nocedal and Wright (the thesis' [100]). Counts iterations, and throws if it finds no
/// improvement: the solver would continue with NaN curvatures.
template <typename Scalar>
struct CountedLineSearch {
    using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

    // NOLINTNEXTLINE(readability-identifier-naming)
    static void LineSearch(Descent& descent, Scalar& value, Vector& weights, Vector& gradient, Scalar& step,
                           const Vector& direction, const Vector& start,
                           const LBFGSpp::LBFGSParam<Scalar>& parameters) {
        check_interrupt();
        ++descent.iterations;
        const Scalar before = value;
        LBFGSpp::LineSearchNocedalWright<Scalar>::LineSearch(descent, value, weights, gradient, step, direction, start,
                                                             parameters);
        if (!(value < before)) throw std::runtime_error("nothing better along the line");
    }
};

LBFGSpp::LBFGSParam<double> descent_parameters(int iterations) {
    LBFGSpp::LBFGSParam<double> parameters;
    parameters.m = 20;
    parameters.epsilon = 1e-7;
    parameters.epsilon_rel = 0;
    parameters.past = 20;
    parameters.delta = 1e-10;
    parameters.max_iterations = iterations;
    parameters.max_linesearch = 40;
    parameters.linesearch = LBFGSpp::LBFGS_LINESEARCH_BACKTRACKING_STRONG_WOLFE;
    return parameters;
}

/// Returns false if the line search failed: near the minimum, rounding can hide any improvement along a direction.
bool descend(Descent& descent, VectorXd weights, int iterations) {
    const auto parameters = descent_parameters(iterations);
    LBFGSpp::LBFGSSolver<double, CountedLineSearch> solver(parameters);
    double value = 0;
    try {
        solver.minimize(descent, weights, value);
        return true;
    } catch (const Error&) {
        throw;
    } catch (const std::runtime_error&) {
        return false;
    } catch (const std::logic_error&) {
        return false;
    }
}

MatrixXf without_rows(const FloatRef& all, Index begin, Index end) {
    MatrixXf out(all.rows() - (end - begin), all.cols());
    out.topRows(begin) = all.topRows(begin);
    out.bottomRows(all.rows() - end) = all.bottomRows(all.rows() - end);
    return out;
}

double held_out_error(const FloatRef& x, const FloatRef& z, Index begin, Index end, const NeuralNetOptions& options) {
    const NeuralNet net = fit_neural_net(without_rows(x, begin, end), without_rows(z, begin, end), options).net;
    const MatrixXf predicted = net.evaluate(x.middleRows(begin, end - begin));
    return (predicted - z.middleRows(begin, end - begin)).cast<double>().squaredNorm();
}

std::vector<NeuralNetOptions> all_candidates(std::span<const std::size_t> neurons, std::span<const double> lambdas,
                                             NeuralNetOptions options) {
    std::vector<NeuralNetOptions> out;
    for (const std::size_t count : neurons) {
        for (const double lambda : lambdas) {
            options.neurons = count, options.lambda = lambda;
            check_net_options(options);
            out.push_back(options);
        }
    }
    if (out.empty())
        throw UsageError("there are no candidates for the neurons or for lambda; give at least one of both");
    return out;
}

}  // namespace

void NeuralNet::evaluate(std::span<const float> x, std::span<float> z) const {
    if (static_cast<Index>(x.size()) != hidden.cols() || static_cast<Index>(z.size()) != output.rows()) {
        throw UsageError(fmt::format("there are {} inputs and {} outputs, but the neural net has {} and {}", x.size(),
                                     z.size(), hidden.cols(), output.rows()));
    }
    const Eigen::Map<const Eigen::VectorXf> in(x.data(), hidden.cols());
    Eigen::Map<Eigen::VectorXf> out(z.data(), output.rows());
    out = output * (hidden * in + hidden_bias).array().tanh().matrix() + output_bias;
}

MatrixXf NeuralNet::evaluate(const FloatRef& x) const {
    if (x.cols() != hidden.cols()) {
        throw UsageError(fmt::format("there are {} inputs, but the neural net has {}", x.cols(), hidden.cols()));
    }
    const MatrixXf active = ((x * hidden.transpose()).rowwise() + hidden_bias.transpose()).array().tanh();
    return (active * output.transpose()).rowwise() + output_bias.transpose();
}

NeuralNetFit fit_neural_net(const FloatRef& x, const FloatRef& z, const NeuralNetOptions& options) {
    check_net_options(options);
    check_data(x, z);
    NeuralNetObjective objective(x.cast<double>(), z.cast<double>(), options);
    const VectorXd units = objective.units();
    Descent descent{objective, objective.scale(), units, objective.start(options.seed).cwiseQuotient(units)};
    constexpr double k_worth_a_restart = 1e-6;
    double before = std::numeric_limits<double>::infinity();
    // After a failure, restarts with steepest descent from the best weights: the old curvatures may have been
    // misleading.
    while (!descend(descent, descent.best, options.iterations - descent.iterations)) {
        if (descent.iterations >= options.iterations || descent.least > (1 - k_worth_a_restart) * before) break;
        before = descent.least;
    }
    return {objective.net(descent.best.cwiseProduct(units)), descent.least * descent.scale, descent.iterations};
}

NeuralNetOptions choose_neural_net(const FloatRef& x, const FloatRef& z, std::span<const std::size_t> neurons,
                                   std::span<const double> lambdas, std::size_t folds,
                                   const NeuralNetOptions& options) {
    check_data(x, z);
    const auto samples = static_cast<std::size_t>(x.rows());
    if (folds < 2 || folds > samples) {
        throw UsageError(
            fmt::format("{} samples cannot be left out in {} folds; give 2 to {}", samples, folds, samples));
    }
    const std::vector<NeuralNetOptions> candidates = all_candidates(neurons, lambdas, options);
    std::vector<double> errors(candidates.size() * folds);
    parallel_for(errors.size(), [&](std::size_t task) {
        const std::size_t fold = task % folds;
        const auto begin = static_cast<Index>(fold * samples / folds);
        const auto end = static_cast<Index>((fold + 1) * samples / folds);
        errors[task] = held_out_error(x, z, begin, end, candidates[task / folds]);
    });
    double least = std::numeric_limits<double>::infinity();
    NeuralNetOptions best = candidates.front();
    for (std::size_t c = 0; c < candidates.size(); ++c) {
        double sum = 0;
        for (std::size_t fold = 0; fold < folds; ++fold) sum += errors[c * folds + fold];
        if (sum < least) least = sum, best = candidates[c];
    }
    return best;
}

}  // namespace exemplar
