#include "host/learn/regression/neural_net.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <vector>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/core/random.h"
#include "host/learn/regression/neural_net_objective.h"

namespace exemplar {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::MatrixXf;
using Eigen::VectorXd;

MatrixXf uniform_matrix(Index rows, Index cols, std::uint64_t seed, double low = -1, double high = 1) {
    Random random(seed);
    return MatrixXf::NullaryExpr(rows, cols, [&] { return static_cast<float>(random.uniform(low, high)); });
}

NeuralNetOptions net_options(std::size_t neurons, double lambda) {
    NeuralNetOptions options;
    options.neurons = neurons;
    options.lambda = lambda;
    return options;
}

/// A net with random weights, for 3 inputs and 2 outputs.
NeuralNet known_net() {
    return {uniform_matrix(4, 3, 1, -2, 2), uniform_matrix(4, 1, 2), uniform_matrix(2, 4, 3), uniform_matrix(2, 1, 4)};
}

TEST(NeuralNet, IsTheFormulaOfTheThesis) {
    const NeuralNet net = known_net();
    const std::vector<float> x{0.3F, -0.7F, 1.1F};
    std::vector<float> z(2);
    net.evaluate(x, z);
    const MatrixXf rows = net.evaluate(Eigen::RowVector3f(x[0], x[1], x[2]));
    for (Index d = 0; d < 2; ++d) {
        double expected = static_cast<double>(net.output_bias(d));
        for (Index l = 0; l < 4; ++l) {
            double sum = static_cast<double>(net.hidden_bias(l));
            for (Index k = 0; k < 3; ++k) sum += static_cast<double>(net.hidden(l, k)) * static_cast<double>(x[k]);
            expected += static_cast<double>(net.output(d, l)) * std::tanh(sum);
        }
        EXPECT_NEAR(z[d], expected, 1e-6);
        EXPECT_NEAR(rows(0, d), expected, 1e-6);
    }
}

TEST(NeuralNet, ObjectiveAndGradientAreThoseOfTheThesis) {
    const MatrixXf x = uniform_matrix(17, 3, 5), z = uniform_matrix(17, 2, 6);
    NeuralNetObjective objective(x.cast<double>(), z.cast<double>(), net_options(5, 0.3));
    ASSERT_EQ(objective.size(), 5 * 4 + 2 * 6);
    const VectorXd at = uniform_matrix(objective.size(), 1, 7).cast<double>() * 2;
    VectorXd gradient, unused;
    const double value = objective.evaluate(at, gradient);
    const NeuralNet net = objective.net(at);
    const double expected = static_cast<double>((net.evaluate(x) - z).squaredNorm()) +
                            0.3 * static_cast<double>(net.hidden.squaredNorm() + net.output.squaredNorm());
    EXPECT_NEAR(value, expected, 1e-5 * expected);
    constexpr double k_step = 1e-5;
    for (Index i = 0; i < at.size(); ++i) {
        const VectorXd step = k_step * VectorXd::Unit(at.size(), i);
        const double slope =
            (objective.evaluate(at + step, unused) - objective.evaluate(at - step, unused)) / (2 * k_step);
        EXPECT_NEAR(gradient(i), slope, 1e-6 * std::max(1.0, std::abs(slope))) << "weight " << i;
    }
}

TEST(NeuralNet, StartsAsInTheThesis) {
    const MatrixXf x = uniform_matrix(9, 8, 8), z = uniform_matrix(9, 3, 9) * 5;
    const NeuralNetObjective objective(x.cast<double>(), z.cast<double>(), net_options(50, 0));
    const NeuralNet net = objective.net(objective.start(1));
    const float deviation = std::sqrt((z.rowwise() - z.colwise().mean()).array().square().mean());
    for (const auto& [values, range] : {std::pair{net.hidden, 1.0F / 50}, std::pair{net.output, deviation / 8}}) {
        EXPECT_LE(values.cwiseAbs().maxCoeff(), range);
        EXPECT_GT(values.maxCoeff(), 0.9F * range);
        EXPECT_LT(values.minCoeff(), -0.9F * range);
    }
}

TEST(NeuralNet, LearnsTanhAndPredictsBetweenItsSamples) {
    const auto target = [](const MatrixXf& x) -> MatrixXf { return (3 * x.array() - 0.5F).tanh() * 2 + 1; };
    const MatrixXf x = uniform_matrix(60, 1, 10), unseen = uniform_matrix(200, 1, 11);
    const NeuralNetFit fit = fit_neural_net(x, target(x), net_options(2, 1e-6));
    EXPECT_LT((fit.net.evaluate(unseen) - target(unseen)).cwiseAbs().maxCoeff(), 5e-3F);
    EXPECT_LT(fit.objective, 1e-3);
}

TEST(NeuralNet, LearnsWhatNoSumOfFunctionsOfSingleInputsIs) {
    const auto target = [](const MatrixXf& x) -> MatrixXf { return x.col(0).cwiseProduct(x.col(1)); };  // as XOR
    const MatrixXf x = uniform_matrix(300, 2, 12), unseen = uniform_matrix(300, 2, 13);
    const NeuralNetFit fit = fit_neural_net(x, target(x), net_options(10, 1e-5));
    EXPECT_LT((fit.net.evaluate(unseen) - target(unseen)).norm(), 0.05F * target(unseen).norm());
}

TEST(NeuralNet, LearnsXor) {
    MatrixXf x(4, 2), z(4, 1);
    x << 0, 0, 0, 1, 1, 0, 1, 1;
    z << 0, 1, 1, 0;
    const NeuralNetFit fit = fit_neural_net(x, z, net_options(4, 1e-6));
    EXPECT_LT((fit.net.evaluate(x) - z).cwiseAbs().maxCoeff(), 0.05F);
}

TEST(NeuralNet, ReproducesANetFromItsOutputs) {
    const MatrixXf x = uniform_matrix(400, 3, 14), unseen = uniform_matrix(100, 3, 15);
    const NeuralNet truth = known_net();
    const NeuralNetFit fit = fit_neural_net(x, truth.evaluate(x), net_options(8, 1e-7));
    EXPECT_LT((fit.net.evaluate(unseen) - truth.evaluate(unseen)).norm(), 0.02F * truth.evaluate(unseen).norm());
}

TEST(NeuralNet, AHugeLambdaLeavesTheMean) {
    const MatrixXf x = uniform_matrix(50, 3, 16), z = uniform_matrix(50, 2, 17).array() + 4;
    const NeuralNetFit fit = fit_neural_net(x, z, net_options(5, 1e6));
    EXPECT_LT((fit.net.evaluate(x).rowwise() - z.colwise().mean()).cwiseAbs().maxCoeff(), 1e-3F);
}

TEST(NeuralNet, TargetsThatDoNotVaryAreLearned) {
    const MatrixXf x = uniform_matrix(20, 2, 18), z = MatrixXf::Constant(20, 3, -7);
    const NeuralNetFit fit = fit_neural_net(x, z, net_options(3, 1e-3));
    EXPECT_LT((fit.net.evaluate(x) - z).cwiseAbs().maxCoeff(), 1e-3F);
    EXPECT_LT((fit_neural_net(x.topRows(1), z.topRows(1), {}).net.evaluate(x.topRows(1)) - z.topRows(1)).norm(), 1e-3F);
    EXPECT_LT((fit_neural_net(MatrixXf(20, 0), z, {}).net.evaluate(MatrixXf(1, 0)) - z.topRows(1)).norm(), 1e-3F);
}

TEST(NeuralNet, StopsCleanlyAtTheEndOfPrecision) {
    // Nothing is left to gain long before the iterations end: line searches fail, and the best net is kept.
    const MatrixXf x = uniform_matrix(6, 2, 19), z = uniform_matrix(6, 1, 20);
    for (const double size : {1e-9, 1.0, 1e9}) {
        const MatrixXf scaled = z * static_cast<float>(size);
        const NeuralNetFit fit = fit_neural_net(x, scaled, net_options(12, 0));
        EXPECT_LT((fit.net.evaluate(x) - scaled).norm(), 1e-2F * scaled.norm()) << size;
        EXPECT_LE(fit.iterations, 5000);
    }
}

TEST(NeuralNet, MoreIterationsNeverFitWorse) {
    const MatrixXf x = uniform_matrix(40, 3, 21), z = uniform_matrix(40, 2, 22);
    double last = std::numeric_limits<double>::infinity();
    for (const int iterations : {1, 3, 10, 50, 500}) {
        NeuralNetOptions options = net_options(6, 1e-3);
        options.iterations = iterations;
        const NeuralNetFit fit = fit_neural_net(x, z, options);
        EXPECT_LE(fit.objective, last);
        EXPECT_LE(fit.iterations, iterations);
        last = fit.objective;
    }
}

TEST(NeuralNet, TheSameSeedGivesTheSameNet) {
    const MatrixXf x = uniform_matrix(40, 3, 23), z = uniform_matrix(40, 2, 24);
    NeuralNetOptions options = net_options(6, 1e-3);
    options.iterations = 100;
    const NeuralNet one = fit_neural_net(x, z, options).net, two = fit_neural_net(x, z, options).net;
    EXPECT_EQ(one.hidden, two.hidden);
    EXPECT_EQ(one.output, two.output);
    options.seed = 2;
    EXPECT_NE(fit_neural_net(x, z, options).net.hidden, one.hidden);
}

/// A product of inputs with noise, in an order that makes neighbors unlike.
struct NoisyProduct {
    MatrixXf x, z;
};

NoisyProduct noisy_product(double noise) {
    NoisyProduct out{uniform_matrix(120, 2, 25), {}};
    out.z = out.x.col(0).cwiseProduct(out.x.col(1)) + static_cast<float>(noise) * uniform_matrix(120, 1, 26);
    return out;
}

TEST(NeuralNetChoice, TakesTheNeuronsAndTheLambdaThatTheDataNeed) {
    NeuralNetOptions options;
    options.iterations = 300;
    options.seed = 5;
    const NoisyProduct exact = noisy_product(0), noise = noisy_product(20);
    const std::vector<std::size_t> neurons{1, 8};
    const std::vector<double> lambdas{1e-5, 1e3};
    const NeuralNetOptions of_exact = choose_neural_net(exact.x, exact.z, neurons, lambdas, 4, options);
    EXPECT_EQ(of_exact.neurons, 8U);
    EXPECT_EQ(of_exact.lambda, 1e-5);
    EXPECT_EQ(of_exact.seed, 5U);
    EXPECT_EQ(of_exact.iterations, 300);
    const std::vector<std::size_t> many{8};
    EXPECT_EQ(choose_neural_net(noise.x, noise.z, many, lambdas, 4, options).lambda, 1e3);
}

TEST(NeuralNetChoice, DoesNotDependOnThreads) {
    const NoisyProduct data = noisy_product(0.5);
    NeuralNetOptions options;
    options.iterations = 40;
    const std::vector<std::size_t> neurons{2, 4, 6};
    const std::vector<double> lambdas{1e-3, 1e-1};
    const NeuralNetOptions many = choose_neural_net(data.x, data.z, neurons, lambdas, 3, options);
    const ThreadLimit one_thread(1);
    const NeuralNetOptions one = choose_neural_net(data.x, data.z, neurons, lambdas, 3, options);
    EXPECT_EQ(one.neurons, many.neurons);
    EXPECT_EQ(one.lambda, many.lambda);
}

TEST(NeuralNet, RefusesWhatItCannotUse) {
    MatrixXf x = uniform_matrix(10, 3, 27);
    const MatrixXf z = uniform_matrix(10, 2, 28);
    EXPECT_THROW(fit_neural_net(x, z.topRows(9)), UsageError);
    EXPECT_THROW(fit_neural_net(x.topRows(0), z.topRows(0)), UsageError);
    EXPECT_THROW(fit_neural_net(x, z, net_options(0, 1)), UsageError);
    EXPECT_THROW(fit_neural_net(x, z, net_options(1, -1)), UsageError);
    NeuralNetOptions options;
    options.iterations = 0;
    EXPECT_THROW(fit_neural_net(x, z, options), UsageError);
    const std::vector<std::size_t> neurons{2};
    const std::vector<double> lambdas{1};
    EXPECT_THROW(choose_neural_net(x, z, {}, lambdas, 2), UsageError);
    EXPECT_THROW(choose_neural_net(x, z, neurons, {}, 2), UsageError);
    EXPECT_THROW(choose_neural_net(x, z, neurons, lambdas, 1), UsageError);
    EXPECT_THROW(choose_neural_net(x, z, neurons, lambdas, 11), UsageError);
    std::vector<float> out(3);
    EXPECT_THROW(known_net().evaluate(out, out), UsageError);
    EXPECT_THROW(known_net().evaluate(MatrixXf(1, 2)), UsageError);
    x(4, 1) = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(fit_neural_net(x, z), DataError);
}

}  // namespace
}  // namespace exemplar
