#include "host/learn/regression/linear_classifier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "host/core/errors.h"
#include "host/core/parallel.h"
#include "host/learn/decompositions.h"
#include "host/learn/regression/gram.h"

namespace exemplar {
namespace {

using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::size_t k_standardized_block = 256;  // rows that are standardized together
constexpr double k_min_variance = 1e-12;           // of the squared mean; below, a feature does not vary

float standardized(float value, float mean, float inverse) {
    const float z = (value - mean) * inverse;
    return std::isnan(z) ? 0 : std::clamp(z, -LinearClassifier::k_max_deviations, LinearClassifier::k_max_deviations);
}

/// Returns the weighted mean of a feature and one over its deviation; (0, 0) if it does not vary or is not finite.
std::pair<float, float> measure(const LinearRows& data, std::size_t feature, double total) {
    const std::span<const float> column = data.features.column(feature);
    double sum = 0, squares = 0;
    for (const std::uint32_t i : data.rows) sum += double{data.weight[i]} * double{column[i]};
    const double mean = sum / total;
    for (const std::uint32_t i : data.rows)
        squares += double{data.weight[i]} * (double{column[i]} - mean) * (double{column[i]} - mean);
    const double variance = squares / total;
    const auto inverse = static_cast<float>(1 / std::sqrt(variance));
    if (!(variance > k_min_variance * mean * mean) || !std::isfinite(variance) || !std::isfinite(inverse))
        return {0.0F, 0.0F};
    return {static_cast<float>(mean), inverse};
}

/// Computes L of `count` rows, of which row_of(i) is the i-th.
template <typename RowOf>
void score(const LinearClassifier& classifier, const FeatureMatrix& features, std::size_t count, const RowOf& row_of,
           std::span<float> out) {
    const std::size_t inputs = classifier.feature_count(), classes = classifier.class_count;
    if (features.cols() < inputs)
        throw ModelError(fmt::format("a linear classifier of {} features got {}", inputs, features.cols()));
    if (out.size() != count * classes)
        throw UsageError("linear_scores: the result has another size than rows x classes");
    const Eigen::Map<const RowMajor> weight(classifier.weight.data(), static_cast<Eigen::Index>(inputs),
                                            static_cast<Eigen::Index>(classes));
    const Eigen::Map<const Eigen::RowVectorXf> constant(classifier.constant.data(), static_cast<Eigen::Index>(classes));
    parallel_for((count + k_standardized_block - 1) / k_standardized_block, [&](std::size_t block) {
        const std::size_t first = block * k_standardized_block, rows = std::min(k_standardized_block, count - first);
        Eigen::MatrixXf z(rows, inputs);
        for (std::size_t f = 0; f < inputs; ++f) {
            const std::span<const float> column = features.column(f);
            float* to = z.data() + f * rows;
            for (std::size_t i = 0; i < rows; ++i)
                to[i] = standardized(column[row_of(first + i)], classifier.mean[f], classifier.inverse[f]);
        }
        Eigen::Map<RowMajor> result(out.data() + first * classes, static_cast<Eigen::Index>(rows),
                                    static_cast<Eigen::Index>(classes));
        result.noalias() = z * weight;
        result.rowwise() += constant;
    });
}

}  // namespace

void linear_scores(const LinearClassifier& classifier, const FeatureMatrix& features, std::span<float> out) {
    score(
        classifier, features, features.rows, [](std::size_t i) { return i; }, out);
}

void linear_scores(const LinearClassifier& classifier, const FeatureMatrix& features,
                   std::span<const std::uint32_t> rows, std::span<float> out) {
    score(
        classifier, features, rows.size(), [&](std::size_t i) { return rows[i]; }, out);
}

LinearTraining::LinearTraining(const LinearRows& data) : classes_(data.classes) {
    const std::size_t rows = data.features.rows, features = data.features.cols();
    if (data.label.size() != rows || data.weight.size() != rows || data.fold.size() != rows)
        throw UsageError("LinearTraining: labels, weights, folds and rows differ in number");
    double total = 0;
    for (const std::uint32_t i : data.rows) total += double{data.weight[i]};
    if (!(total > 0)) throw UsageError("LinearTraining: there is no row of any weight");

    standard_.class_count = static_cast<std::uint32_t>(classes_);
    standard_.mean.resize(features), standard_.inverse.resize(features);
    parallel_for(features,
                 [&](std::size_t f) { std::tie(standard_.mean[f], standard_.inverse[f]) = measure(data, f, total); });
    for (std::uint32_t f = 0; f < features; ++f)
        if (standard_.inverse[f] > 0) used_.push_back(f);
    for (std::size_t fold = 0; fold < data.fold_count; ++fold) {
        std::vector<std::uint32_t> inside;
        for (const std::uint32_t i : data.rows)
            if (data.fold[i] == fold && data.weight[i] > 0) inside.push_back(i);
        of_fold_.push_back(products_of(data, inside, total));
    }
}

Eigen::MatrixXd LinearTraining::products_of(const LinearRows& data, std::span<const std::uint32_t> rows,
                                            double total) const {
    const auto inputs = static_cast<Eigen::Index>(used_.size());
    const auto size = inputs + 1 + static_cast<Eigen::Index>(classes_);
    return gram_of_chunks(size, static_cast<Eigen::Index>(rows.size()), [&](Eigen::Index begin, Eigen::Index end) {
        Eigen::MatrixXd part = Eigen::MatrixXd::Zero(size, end - begin);
        const auto chunk = rows.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin));
        for (Eigen::Index k = 0; k < part.cols(); ++k) {
            const std::uint32_t row = chunk[static_cast<std::size_t>(k)];
            part(inputs, k) = 1;
            part(inputs + 1 + data.label[row], k) = 1;
        }
        for (Eigen::Index u = 0; u < inputs; ++u) {
            const std::uint32_t f = used_[static_cast<std::size_t>(u)];
            const std::span<const float> column = data.features.column(f);
            for (Eigen::Index k = 0; k < part.cols(); ++k)
                part(u, k) = double{
                    standardized(column[chunk[static_cast<std::size_t>(k)]], standard_.mean[f], standard_.inverse[f])};
        }
        for (Eigen::Index k = 0; k < part.cols(); ++k)
            part.col(k) *= std::sqrt(double{data.weight[chunk[static_cast<std::size_t>(k)]]} / total);
        return part;
    });
}

Eigen::MatrixXd LinearTraining::products(std::size_t without_fold) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(of_fold_.front().rows(), of_fold_.front().cols());
    for (std::size_t fold = 0; fold < of_fold_.size(); ++fold)
        if (fold != without_fold) sum += of_fold_[fold];
    return sum;
}

LinearClassifier LinearTraining::solve(double ridge, std::size_t without_fold) const {
    const Eigen::MatrixXd sums = products(without_fold);
    const auto inputs = static_cast<Eigen::Index>(used_.size()), classes = static_cast<Eigen::Index>(classes_);
    LinearClassifier result = standard_;
    result.weight.assign(standard_.feature_count() * classes_, 0.0F);
    result.constant.assign(classes_, 0.0F);
    const double total = sums(inputs, inputs);
    if (!(total > 0)) return result;
    // Centered on the means of these rows, so that the constant drops out of the equations.
    const Eigen::VectorXd mean = sums.col(inputs).head(inputs) / total;
    const Eigen::RowVectorXd target = sums.row(inputs).tail(classes) / total;
    Eigen::MatrixXd gram = sums.topLeftCorner(inputs, inputs) - total * mean * mean.transpose();
    gram.diagonal().array() += ridge * total;
    const Eigen::MatrixXd weight =
        solve_cholesky(std::move(gram), sums.topRightCorner(inputs, classes) - total * mean * target);
    for (Eigen::Index u = 0; u < inputs; ++u)
        for (Eigen::Index c = 0; c < classes; ++c)
            result.weight[used_[static_cast<std::size_t>(u)] * classes_ + static_cast<std::size_t>(c)] =
                static_cast<float>(weight(u, c));
    const Eigen::RowVectorXd constant = target - mean.transpose() * weight;
    for (Eigen::Index c = 0; c < classes; ++c)
        result.constant[static_cast<std::size_t>(c)] = static_cast<float>(constant(c));
    return result;
}

LinearClassifier mean_linear(std::span<const LinearClassifier> classifiers) {
    LinearClassifier result = classifiers.front();
    const auto add = [](std::vector<float>& to, const std::vector<float>& from) {
        for (std::size_t i = 0; i < to.size(); ++i) to[i] += from[i];
    };
    for (const LinearClassifier& other : classifiers.subspan(1))
        add(result.weight, other.weight), add(result.constant, other.constant);
    for (std::vector<float>* values : {&result.weight, &result.constant})
        for (float& value : *values) value /= static_cast<float>(classifiers.size());
    return result;
}

}  // namespace exemplar
