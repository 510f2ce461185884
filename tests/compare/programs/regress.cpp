// Fits a regression of the library to many data sets and predicts, so that it can be compared with other learners.
//   compare_regress METHOD IN OUT
// METHOD: least_squares, ridge, network or product. IN, a safetensors file: x (sets x rows x inputs), y (sets x rows),
// test (sets x rows x inputs); OUT: y (sets x rows) of the test rows. All are F32. Targets of product are positive.

#include <fmt/format.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/data/safetensors.h"
#include "host/hatching/features/powers.h"
#include "host/hatching/style/property_model.h"
#include "host/learn/regression/least_squares.h"
#include "host/learn/regression/neural_net.h"

namespace exemplar {
namespace {

using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// The inputs behind a column of ones.
Eigen::MatrixXd with_constant(const Rows& x) {
    Eigen::MatrixXd features(x.rows(), x.cols() + 1);
    features.col(0).setOnes();
    features.rightCols(x.cols()) = x.cast<double>();
    return features;
}

Eigen::VectorXf by_least_squares(const Rows& x, const Eigen::VectorXf& y, const Rows& test, bool with_ridge) {
    std::vector<double> ridges;  // per sample; of all samples from 1e-5 to 1e3 in steps of half a decade
    for (int step = -10; step <= 6; ++step) ridges.push_back(std::pow(10, 0.5 * step) / static_cast<double>(x.rows()));
    const Eigen::MatrixXd features = with_constant(x), targets = y.cast<double>();
    const double ridge = with_ridge ? leave_one_out(features, targets, ridges).ridge : 0;
    const Eigen::MatrixXd weights = LeastSquares(features, ridge).solve(targets);
    return (with_constant(test) * weights).cast<float>();
}

Eigen::VectorXf by_network(const Rows& x, const Eigen::VectorXf& y, const Rows& test) {
    constexpr std::array<std::size_t, 2> k_neurons{2, 5};
    constexpr std::array<double, 3> k_lambdas{0.01, 0.1, 1};
    const NeuralNetOptions options = choose_neural_net(x, y, k_neurons, k_lambdas, 5);
    return fit_neural_net(x, y, options).net.evaluate(test);
}

FeatureMatrix feature_matrix(const Rows& x) {
    FeatureMatrix features;
    features.rows = static_cast<std::size_t>(x.rows());
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
        const std::span<float> column = features.add(fmt::format("x{}", k));
        for (Eigen::Index i = 0; i < x.rows(); ++i) column[static_cast<std::size_t>(i)] = x(i, k);
    }
    return features;
}

/// The products of functions of single features that hatching learns; every fourth row decides when to stop.
Eigen::VectorXf by_products(const Rows& x, const Eigen::VectorXf& y, const Rows& test) {
    const FeatureMatrix features = feature_matrix(x), unseen = feature_matrix(test);
    std::vector<std::uint8_t> held_out, block;
    for (std::size_t i = 0; i < features.rows; ++i) {
        held_out.push_back(i % 4 == 0);
        block.push_back(static_cast<std::uint8_t>(k_property_blocks * i / features.rows));
    }
    const std::span<const float> target(y.data(), features.rows);
    const PropertyModel model = learn_property({features, quantize(features, {}, {}), target, held_out, block}).model;
    Eigen::VectorXf predicted(test.rows());
    for (std::size_t i = 0; i < unseen.rows; ++i)
        predicted[static_cast<Eigen::Index>(i)] =
            model.evaluate([&](std::uint32_t k) { return power_of(unseen.column(k / k_powers)[i], k % k_powers); });
    return predicted;
}

Eigen::VectorXf predict(const std::string& method, const Rows& x, const Eigen::VectorXf& y, const Rows& test) {
    if (method == "least_squares") return by_least_squares(x, y, test, false);
    if (method == "ridge") return by_least_squares(x, y, test, true);
    if (method == "network") return by_network(x, y, test);
    if (method == "product") return by_products(x, y, test);
    throw UsageError(fmt::format("unknown method '{}'", method));
}

void regress(const std::string& method, const char* in, const char* out) {
    constexpr std::size_t k_any = TensorFile::k_any;
    const TensorFile file = read_safetensors(in);
    const auto x = file.get<float>("x", {k_any, k_any, k_any}), y = file.get<float>("y", {k_any, k_any}),
               test = file.get<float>("test", {k_any, k_any, k_any});
    const std::vector<std::size_t>& shape = file.tensors.at("x").shape;
    const std::size_t sets = shape[0], rows = shape[1], inputs = shape[2];
    const std::size_t test_rows = file.tensors.at("test").shape[1];
    std::vector<float> predicted;
    for (std::size_t set = 0; set < sets; ++set) {
        const auto matrix = [&](const std::vector<float>& values, std::size_t count) {
            return Rows(Eigen::Map<const Rows>(values.data() + set * count * inputs, static_cast<Eigen::Index>(count),
                                               static_cast<Eigen::Index>(inputs)));
        };
        const Eigen::VectorXf targets =
            Eigen::Map<const Eigen::VectorXf>(y.data() + set * rows, static_cast<Eigen::Index>(rows));
        const Eigen::VectorXf of_set = predict(method, matrix(x, rows), targets, matrix(test, test_rows));
        predicted.insert(predicted.end(), of_set.begin(), of_set.end());
    }
    TensorFile result;
    result.add("y", {sets, test_rows}, predicted);
    write_safetensors(out, result);
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    try {
        if (count != 4) throw exemplar::UsageError("expected 3 arguments, see the head of regress.cpp");
        exemplar::regress(arguments[1], arguments[2], arguments[3]);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
